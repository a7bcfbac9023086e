#ifndef WIIMOTE_TRACKER_TRIANGULATION_MEASUREMENTS_OUTPUT_FILE_H
#define WIIMOTE_TRACKER_TRIANGULATION_MEASUREMENTS_OUTPUT_FILE_H

#include <cstdio>
#include <memory>
#include <string>

namespace wiimote_tracker::measurements {

/// A file that is called path + ".part" until it is complete (part_file.h). All throw Error.
class OutputFile {
 public:
  explicit OutputFile(const std::string& path);

  void write(const std::string& bytes);
  void flush();
  void finish();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace wiimote_tracker::measurements

#endif  // WIIMOTE_TRACKER_TRIANGULATION_MEASUREMENTS_OUTPUT_FILE_H
