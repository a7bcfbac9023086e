#pragma once

#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <unistd.h>

namespace wiimote_tracker::import {

/// A temporary folder of small text files, gone at the end of the test.
class Folder {
 public:
  Folder() {
    char pattern[] = "/tmp/import_XXXXXX";
    if (mkdtemp(pattern) == nullptr)
      throw std::runtime_error("no temporary folder");
    path_ = pattern;
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    for (const std::string& file : files_)
      unlink(file.c_str());
    rmdir(path_.c_str());
  }

  const std::string& path() const { return path_; }

  void write(const std::string& name, const std::string& text) {
    files_.push_back(path_ + "/" + name);
    std::ofstream(files_.back()) << text;
  }

  void remove(const std::string& name) { unlink((path_ + "/" + name).c_str()); }

 private:
  std::string path_;
  std::vector<std::string> files_;
};

}  // namespace wiimote_tracker::import
