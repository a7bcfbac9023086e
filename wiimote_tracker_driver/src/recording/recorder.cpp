#include "recording/recorder.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace wiimote_tracker::recording {
namespace {

constexpr auto kWriteInterval = std::chrono::seconds(1);
// Some minutes of reports, for slow disks [byte].
constexpr std::size_t kCapacity = 1 << 20;
constexpr int kMaxNames = 10000;

/// The n-th name for a recording: "a/b.wiirec", "a/b_2.wiirec", ...
std::string numbered(const std::filesystem::path& path, int n) {
  const std::string suffix = n == 1 ? "" : "_" + std::to_string(n);
  return path.parent_path() / (path.stem().string() + suffix + path.extension().string());
}

std::string cannotWrite(int error) {
  return std::string("because it cannot be written (") + std::strerror(error) +
         "): make room on the disk or record to another one";
}

/// Creates a file with the first free name. @returns its descriptor; sets `path` to its name.
int create(std::string& path) {
  const std::string wanted = path;
  // Otherwise the file would get a number and lie beside the folder or device.
  std::error_code ignored;
  const auto status = std::filesystem::status(wanted, ignored);
  if (std::filesystem::is_directory(status))
    throw BadRecording("cannot create the recording " + wanted +
                       " (it is a folder): name a file in it");
  if (std::filesystem::is_other(status))
    throw BadRecording("cannot create the recording " + wanted +
                       " (it is a device or a pipe): name a file");
  for (int n = 1; n < kMaxNames; ++n) {
    path = numbered(wanted, n);
    const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd >= 0)
      return fd;
    if (errno != EEXIST)
      break;
  }
  throw BadRecording("cannot create the recording " + wanted + " (" + std::strerror(errno) +
                     "): choose a place where this user may write");
}

}  // namespace

Recorder::Recorder(const std::string& path, double now, double wall_time)
    : path_(path), begin_(now), fd_(create(path_)) {
  filling_.reserve(kCapacity);
  writing_.reserve(kCapacity);
  append(FileHeader{wall_time, "wiimote_tracker_driver " WIIMOTE_TRACKER_DRIVER_VERSION}, filling_);
  thread_ = std::thread([this] { run(); });
}

std::string Recorder::finish() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable())
    thread_.join();
  return error();
}

std::string Recorder::error() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return error_;
}

void Recorder::fail(const std::string& why) {
  error_ = "the recording " + path_ + " has ended, " + why;
}

void Recorder::add(Record record) {
  record.time -= begin_;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!error_.empty())
    return;
  if (filling_.size() + kRecordHeaderSize + kLongestPayload > kCapacity) {
    fail("because the disk is too slow: record to another one");
    return;
  }
  append(record, filling_);
  if (filling_.size() > kCapacity / 2)
    wake_.notify_one();
}

void Recorder::run() {
  // Blocks SIGXFSZ, too, which would end the process when the file is too large.
  sigset_t all;
  sigfillset(&all);
  ::pthread_sigmask(SIG_BLOCK, &all, nullptr);
  bool last = false;
  while (!last) {
    {
      std::unique_lock<std::mutex> lock(mutex_);
      wake_.wait_for(lock, kWriteInterval,
                     [this] { return stop_ || filling_.size() > kCapacity / 2; });
      last = stop_;
      filling_.swap(writing_);
    }
    std::string why = write();
    if (last && why.empty())
      why = close();
    writing_.clear();
    if (!why.empty()) {
      const std::lock_guard<std::mutex> lock(mutex_);
      fail(why);
      return;
    }
  }
}

/// @returns what went wrong; empty on success.
std::string Recorder::write() const {
  struct stat file {};
  if (::fstat(fd_.get(), &file) == 0 && file.st_nlink == 0)
    return "because it was deleted: leave it in place while the driver runs";
  std::size_t done = 0;
  while (done < writing_.size()) {
    const ssize_t size = ::write(fd_.get(), writing_.data() + done, writing_.size() - done);
    if (size < 0 && errno != EINTR)
      return cannotWrite(errno);
    if (size > 0)
      done += static_cast<std::size_t>(size);
  }
  return "";
}

/// Some file systems, such as NFS, write only now. @returns as write().
std::string Recorder::close() {
  return ::close(fd_.release()) == 0 ? "" : cannotWrite(errno);
}

}  // namespace wiimote_tracker::recording
