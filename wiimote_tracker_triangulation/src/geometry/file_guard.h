#pragma once

#include "wiimote_tracker_triangulation/geometry/atomic_file.h"
#include "wiimote_tracker_triangulation/geometry/error.h"

#include <filesystem>
#include <string>
#include <system_error>

namespace wiimote_tracker::geometry {

/// Keeps a program that read a file once from writing over what a person changed in it since. The
/// file need not exist.
class FileGuard {
 public:
  /// Remembers the content: construct it before the file is read. @throws FileError.
  explicit FileGuard(const std::string& path) : path_(path), content_(contentOf(path)) {}

  /// Before writing. @throws FileError: the file exists and is not as remembered.
  void check() const {
    const std::string content = contentOf(path_);
    if (!content.empty() && content != content_)
      throw FileError(path_ + " was changed after it was read: restart the node that reads it");
  }

  /// After writing: remembers the content. @throws FileError.
  void update() { content_ = contentOf(path_); }

 private:
  static std::string contentOf(const std::string& path) {
    std::error_code error;
    return std::filesystem::exists(path, error) ? readFile(path) : "";
  }

  std::string path_;
  std::string content_;  // empty: there was no file
};

}  // namespace wiimote_tracker::geometry
