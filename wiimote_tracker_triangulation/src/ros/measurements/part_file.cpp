#include "ros/measurements/part_file.h"

#include "wiimote_tracker_triangulation/geometry/error.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace wiimote_tracker::measurements {
namespace {

namespace fs = std::filesystem;

/// @throws fs::filesystem_error.
void keepPart(const std::string& part) {
  if (!fs::is_regular_file(part) || fs::file_size(part) == 0)
    return;
  std::string kept = part + ".bak";
  for (int i = 2; fs::exists(kept); ++i)
    kept = part + ".bak" + std::to_string(i);
  fs::rename(part, kept);
}

bool isSameFile(const std::string& a, const std::string& b) {
  std::error_code ignored;
  return fs::absolute(a).lexically_normal() == fs::absolute(b).lexically_normal() ||
         fs::equivalent(a, b, ignored);
}

}  // namespace

std::string partOf(const std::string& path) {
  return path + ".part";
}

void checkDistinct(const std::vector<std::string>& to_write,
                   const std::vector<std::string>& to_read) {
  std::vector<std::string> others = to_read;
  for (const std::string& file : to_write) {
    for (const std::string& other : others) {
      if (!file.empty() && !other.empty() && isSameFile(file, other))
        throw Error("two arguments are " + file + ": write to another one");
    }
    others.push_back(file);
  }
}

void failToWrite(const std::string& path, int error) {
  throw Error("cannot write " + path + " (" + std::strerror(error) +
              "): choose another place or make room there");
}

void createPart(const std::string& path) {
  try {
    fs::create_directories(fs::absolute(path).parent_path());
    if (fs::is_directory(path))
      failToWrite(path, EISDIR);
    if (fs::exists(path) && !fs::is_regular_file(path))  // finishPart() would rename over it
      throw Error("cannot write " + path + ", it is a device or a pipe: name a file");
    keepPart(partOf(path));
  } catch (const fs::filesystem_error& e) {
    failToWrite(path, e.code().value());
  }
  std::FILE* file = std::fopen(partOf(path).c_str(), "wb");
  if (!file)
    failToWrite(path, errno);
  std::fclose(file);
}

void finishPart(const std::string& path) {
  const std::string part = partOf(path);
  const int file = ::open(part.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0)
    failToWrite(path, errno);
  const int synced = ::fsync(file);
  const int error = errno;
  ::close(file);
  if (synced != 0)
    failToWrite(path, error);
  const std::string kept = path + ".bak";
  if (::access(path.c_str(), F_OK) == 0) {
    if (::unlink(kept.c_str()) != 0 && errno != ENOENT)
      failToWrite(kept, errno);
    // FAT has no hard links.
    if (::link(path.c_str(), kept.c_str()) != 0 && std::rename(path.c_str(), kept.c_str()) != 0)
      failToWrite(kept, errno);
  }
  if (std::rename(part.c_str(), path.c_str()) != 0)
    failToWrite(path, errno);
}

OutputFile::OutputFile(const std::string& path) : path_(path) {
  createPart(path_);
  file_.reset(std::fopen(partOf(path_).c_str(), "wb"));
  if (!file_)
    failToWrite(path_, errno);
}

void OutputFile::write(const std::string& bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size())
    failToWrite(path_, errno);
}

void OutputFile::flush() {
  if (std::fflush(file_.get()) != 0)
    failToWrite(path_, errno);
}

void OutputFile::finish() {
  flush();
  if (std::fclose(file_.release()) != 0)
    failToWrite(path_, errno);
  finishPart(path_);
}

void OutputFile::discard() {
  ::unlink(partOf(path_).c_str());
}

}  // namespace wiimote_tracker::measurements
