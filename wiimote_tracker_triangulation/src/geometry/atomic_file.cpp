#include "wiimote_tracker_triangulation/geometry/atomic_file.h"

#include "wiimote_tracker_triangulation/geometry/error.h"

#include <wiimote_tracker_msgs/text.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <limits>
#include <mutex>

namespace wiimote_tracker::geometry {
namespace {

[[noreturn]] void fail(const std::string& what, const std::string& path, int error) {
  throw FileError("cannot " + what + " " + path + " (" + std::strerror(error) +
                  "); check its permissions and free space, or choose another path");
}

class FileDescriptor {
 public:
  explicit FileDescriptor(int fd) : fd_(fd) {}
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  ~FileDescriptor() {
    if (fd_ >= 0)
      ::close(fd_);
  }
  int get() const { return fd_; }

 private:
  int fd_;
};

void writeAndSync(const std::string& path, const std::string& content) {
  const FileDescriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (file.get() < 0)
    fail("create", path, errno);
  for (std::size_t done = 0; done < content.size();) {
    const ssize_t n = ::write(file.get(), content.data() + done, content.size() - done);
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0)
      fail("write", path, errno);
    done += static_cast<std::size_t>(n);
  }
  if (::fsync(file.get()) != 0)
    fail("write", path, errno);
}

/// Replaces the file by a rename, which is atomic within a folder.
void replace(const std::filesystem::path& path, const std::string& content) {
  static std::atomic<unsigned> count{0};
  const std::string fresh =
      path.string() + ".new" + std::to_string(::getpid()) + "." + std::to_string(count++);
  try {
    writeAndSync(fresh, content);
    if (::rename(fresh.c_str(), path.c_str()) != 0)
      fail("replace", path.string(), errno);
  } catch (const FileError&) {
    ::unlink(fresh.c_str());
    throw;
  }
  // So that the rename survives a power failure, if the file system supports it.
  const FileDescriptor folder(
      ::open(path.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.get() >= 0)
    ::fsync(folder.get());
}

}  // namespace

void writeFileAtomically(const std::string& path, const std::string& content) {
  namespace fs = std::filesystem;
  static std::mutex mutex;  // of the old file and its backup
  const std::lock_guard<std::mutex> lock(mutex);
  try {
    fs::path target = fs::absolute(path);
    if (fs::is_symlink(target))
      target = fs::weakly_canonical(target);
    fs::create_directories(target.parent_path());
    if (fs::exists(target))
      replace(target.string() + ".bak",
              readFile(target.string(), std::numeric_limits<std::size_t>::max()));
    replace(target, content);
  } catch (const fs::filesystem_error& e) {
    fail("write", path, e.code().value());
  }
}

std::string readFile(const std::string& path, std::size_t largest) {
  // Opening a FIFO would wait for its writer.
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  struct stat status {};
  if (file.get() < 0 || ::fstat(file.get(), &status) != 0)
    fail("read", path, errno);
  if (!S_ISREG(status.st_mode))
    throw FileError("cannot read " + path + ", it is " +
                    (S_ISDIR(status.st_mode) ? "a folder" : "a device or a pipe") +
                    "; name a file");
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size > largest)
    throw FileError(format(
        "cannot read %s, its %.0f MB are more than the %.0f MB of the largest "
        "file of this kind; name another file",
        path.c_str(), 1e-6 * static_cast<double>(size), 1e-6 * static_cast<double>(largest)));
  std::string content(size, '\0');
  for (std::size_t done = 0; done < size;) {
    const ssize_t n = ::read(file.get(), content.data() + done, size - done);
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0)
      fail("read", path, errno);
    if (n == 0)
      content.resize(done);  // became shorter
    done = n == 0 ? size : done + static_cast<std::size_t>(n);
  }
  return content;
}

}  // namespace wiimote_tracker::geometry
