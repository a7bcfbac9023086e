#include "geometry/file_guard.h"

#include "wiimote_tracker_triangulation/geometry/atomic_file.h"
#include "wiimote_tracker_triangulation/geometry/error.h"

#include <filesystem>
#include <system_error>

namespace wiimote_tracker::geometry {
namespace {

std::string contentOf(const std::string& path) {
  std::error_code error;
  return std::filesystem::exists(path, error) ? readFile(path) : "";
}

}  // namespace

FileGuard::FileGuard(const std::string& path) : path_(path), content_(contentOf(path)) {}

void FileGuard::check() const {
  const std::string content = contentOf(path_);
  if (!content.empty() && content != content_)
    throw FileError(path_ + " was changed after it was read: restart the node that reads it");
}

void FileGuard::update() {
  content_ = contentOf(path_);
}

}  // namespace wiimote_tracker::geometry
