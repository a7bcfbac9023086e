#pragma once

#include "geometry/full_rig.h"
#include "refusal_of.h"
#include "wiimote_tracker_triangulation/geometry/rig_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace wiimote_tracker::geometry::test {

class RigFile : public testing::Test {
 protected:
  RigFile() {
    std::string pattern = (std::filesystem::temp_directory_path() / "rig_file_XXXXXX").string();
    folder_ = mkdtemp(&pattern[0]);
    path_ = (folder_ / "rig.yaml").string();
  }
  ~RigFile() override { std::filesystem::remove_all(folder_); }

  static std::string contentOf(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }

  void put(const std::string& content) { std::ofstream(path_, std::ios::binary) << content; }

  /// The error of readRigFile.
  static std::string complaint(const std::string& path) {
    return refusalOf([&] { readRigFile(path); });
  }

  std::string complaintAbout(const std::string& content) {
    put(content);
    return complaint(path_);
  }

  /// The file's content with one text replaced by another.
  std::string with(const std::string& from, const std::string& to) const {
    std::string content = written_;
    const std::size_t place = content.find(from);
    if (place == std::string::npos)
      throw std::logic_error("the test looks for '" + from + "', which is not in the file");
    return content.replace(place, from.size(), to);
  }

  void write(const Rig& rig) {
    writeRigFile(rig, path_);
    written_ = contentOf(path_);
  }

  std::filesystem::path folder_;
  std::string path_;
  std::string written_;
};

}  // namespace wiimote_tracker::geometry::test
