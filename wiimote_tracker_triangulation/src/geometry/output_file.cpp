#include "geometry/output_file.h"

#include "wiimote_tracker_triangulation/geometry/error.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace wiimote_tracker::geometry {
namespace {

namespace fs = std::filesystem;

constexpr int kMostOpenings = 100;  // while other programs finish the same file

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
        throw FileError("two arguments are " + file + ": write to another one");
    }
    others.push_back(file);
  }
}

void failToWrite(const std::string& path, int error) {
  throw FileError("cannot write " + path + " (" + std::strerror(error) +
                  "): check the permissions, choose another place or make room there");
}

OutputFile::OutputFile(const std::string& path, bool keeps_part) : path_(path) {
  const std::string part = partOf(path);
  try {
    const fs::path folder = fs::absolute(path).parent_path();
    if (!fs::is_directory(folder))  // libstdc++ 10 refuses to create one that is a link to a folder
      fs::create_directories(folder);
    if (fs::is_directory(path))
      failToWrite(path, EISDIR);
    if (fs::exists(path) && !fs::is_regular_file(path))  // finish() would rename over it
      throw FileError("cannot write " + path + ", it is a device or a pipe: name a file");
    openPart();
    if (keeps_part && fs::file_size(part) > 0) {
      std::string kept = part + ".bak";
      for (int i = 2; fs::exists(kept); ++i)
        kept = part + ".bak" + std::to_string(i);
      fs::rename(part, kept);
      openPart();
    }
  } catch (const fs::filesystem_error& e) {
    failToWrite(path, e.code().value());
  }
  if (::ftruncate(::fileno(file_.get()), 0) != 0)
    failToWrite(path, errno);
}

/// Creates the part where there is none, and locks it.
void OutputFile::openPart() {
  for (int i = 0; i < kMostOpenings; ++i) {
    file_.reset(std::fopen(partOf(path_).c_str(), "abe"));
    if (!file_)
      failToWrite(partOf(path_), errno);
    if (::flock(::fileno(file_.get()), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      throw FileError("another program writes " + path_ +
                      ": wait until it has ended, or name another file");
    if (isNamedAsPart())  // else another program has just finished it
      return;
  }
  failToWrite(path_, ESTALE);  // a file system whose files have no lasting numbers
}

bool OutputFile::isNamedAsPart() const {
  struct stat mine {};
  struct stat present {};
  return ::fstat(::fileno(file_.get()), &mine) == 0 &&
         ::stat(partOf(path_).c_str(), &present) == 0 && mine.st_ino == present.st_ino;
}

void OutputFile::write(const std::string& bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size())
    fail();
}

void OutputFile::flush() {
  if (failed_ != 0)
    failToWrite(path_, failed_);
  if (std::fflush(file_.get()) != 0)
    fail();
}

/// The C library drops what it could not write: the next call may succeed.
void OutputFile::fail() {
  failed_ = errno;
  failToWrite(path_, failed_);
}

void OutputFile::finish() {
  flush();
  if (::fsync(::fileno(file_.get())) != 0)
    failToWrite(path_, errno);
  if (::access(path_.c_str(), F_OK) == 0)
    keep();
  if (std::rename(partOf(path_).c_str(), path_.c_str()) != 0)
    failToWrite(path_, errno);
  // So that the rename survives a power failure, if the file system supports it.
  const int folder =
      ::open(fs::absolute(path_).parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) {
    ::fsync(folder);
    ::close(folder);
  }
  file_.reset();
}

/// Keeps the file as path + ".bak". A crash leaves this one or the one of before.
void OutputFile::keep() const {
  const std::string kept = path_ + ".bak";
  const std::string fresh = partOf(kept);
  ::unlink(fresh.c_str());  // a crash may have left it
  std::error_code error;
  // FAT has no links; of a large file it may have no room for a copy.
  const bool is_there =
      ::link(path_.c_str(), fresh.c_str()) == 0 || fs::copy_file(path_, fresh, error);
  const int failed = std::rename((is_there ? fresh : path_).c_str(), kept.c_str()) != 0 ? errno : 0;
  ::unlink(fresh.c_str());  // half a copy, or a link to a file that is kept already
  if (failed != 0)
    failToWrite(kept, failed);
}

void OutputFile::discard() {
  if (file_ && isNamedAsPart())  // another program may have begun its own
    ::unlink(partOf(path_).c_str());
}

}  // namespace wiimote_tracker::geometry
