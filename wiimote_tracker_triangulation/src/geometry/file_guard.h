#ifndef WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_FILE_GUARD_H
#define WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_FILE_GUARD_H

#include <string>

namespace wiimote_tracker::geometry {

/// Keeps a program that read a file once from writing over what a person changed in it since. The
/// file need not exist.
class FileGuard {
 public:
  /// Remembers the content: construct it before the file is read. @throws FileError.
  explicit FileGuard(const std::string& path);

  /// Before writing. @throws FileError: the file exists and is not as remembered.
  void check() const;

  /// After writing: remembers the content. @throws FileError.
  void update();

 private:
  std::string path_;
  std::string content_;  // empty: there was no file
};

}  // namespace wiimote_tracker::geometry

#endif  // WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_FILE_GUARD_H
