#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace wiimote_tracker::geometry {

/// Name of a file while it is being written.
std::string partOf(const std::string& path);

/// Empty names are no files. @throws FileError: a file to write is also to be read, or to be
/// written as something else.
void checkDistinct(const std::vector<std::string>& to_write,
                   const std::vector<std::string>& to_read = {});

/// @throws FileError with the reason for `error`, an errno.
[[noreturn]] void failToWrite(const std::string& path, int error);

/// A file that is written as its part until it is complete. All throw FileError.
class OutputFile {
 public:
  /// Creates the folder and an empty part, which is locked against other programs. Refuses a
  /// folder, a device, a pipe, and what another program writes.
  /// @param keeps_part renames a part that a crash left, unless it is empty, to path + ".part.bak",
  /// or ".part.bak2" and so on where that exists.
  explicit OutputFile(const std::string& path, bool keeps_part = true);

  void write(const std::string& bytes);  ///< After it failed, flush() and finish() throw, too.
  void flush();

  /// Syncs the part to disk and renames it: for every reader, and after a crash, the file has its
  /// old content or all of the new. Keeps an existing file as path + ".bak". Where it throws, the
  /// part stays, and the file is as it was. On a full disk whose file system has no links it may be
  /// there as path + ".bak" only.
  void finish();

  void discard();  ///< Removes the part, if it is not finished. Throws nothing.

 private:
  void openPart();
  [[noreturn]] void fail();
  bool isNamedAsPart() const;
  void keep() const;

  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;  // the part
  int failed_ = 0;                          // errno when bytes were lost; 0: none were
};

}  // namespace wiimote_tracker::geometry
