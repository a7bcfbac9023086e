#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_MEASUREMENTS_PART_FILE_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_MEASUREMENTS_PART_FILE_H

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace wiimote_tracker::measurements {

/// Name of a file while it is being written.
std::string partOf(const std::string& path);

/// Empty names are no files. @throws Error: a file to write is also to be read, or to be written as
/// something else.
void checkDistinct(const std::vector<std::string>& to_write,
                   const std::vector<std::string>& to_read = {});

/// Creates the file's folder and an empty part. A part that a program left when it crashed is kept,
/// unless empty, as path + ".part.bak", or ".part.bak2" and so on where that exists. @throws Error,
/// also where the path is a folder, a device or a pipe.
void createPart(const std::string& path);

/// Syncs the part to disk and renames it atomically; keeps an existing file as path + ".bak".
/// @throws Error; then the part stays.
void finishPart(const std::string& path);

/// @throws Error with the reason for `error`, an errno.
[[noreturn]] void failToWrite(const std::string& path, int error);

/// A file that is written as its part until it is complete. All throw Error.
class OutputFile {
 public:
  explicit OutputFile(const std::string& path);

  void write(const std::string& bytes);
  void flush();
  void finish();
  void discard();  ///< Removes the part, if it is not finished. Throws nothing.

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace wiimote_tracker::measurements

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_MEASUREMENTS_PART_FILE_H
