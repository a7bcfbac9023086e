#ifndef WIIMOTE_TRACKER_DRIVER_BENCHMARK_FOLDER_H
#define WIIMOTE_TRACKER_DRIVER_BENCHMARK_FOLDER_H

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace wiimote_tracker {

/// A folder for sockets, removed with its content at the end.
class Folder {
 public:
  Folder() {
    char name[] = "/tmp/benchmark_driver_XXXXXX";
    if (!::mkdtemp(name))
      throw std::runtime_error("no folder can be made in /tmp: make room there");
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_DRIVER_BENCHMARK_FOLDER_H
