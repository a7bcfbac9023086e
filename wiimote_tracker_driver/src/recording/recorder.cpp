#include "wiimote_tracker_driver/recording/recorder.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace wiimote_tracker::recording {
namespace {

constexpr auto kWriteInterval = std::chrono::seconds(1);
// Some minutes of reports, in case the disk has to be waited for [byte].
constexpr std::size_t kCapacity = 1 << 20;
constexpr int kMostNames = 10000;

/// The n-th name for a recording: "a/b.wiirec", "a/b_2.wiirec", ...
std::string numbered(const std::string& path, int n) {
  if (n == 1)
    return path;
  const std::size_t name = path.rfind('/') + 1;  // 0 without a slash
  const std::size_t dot = path.rfind('.');
  const std::size_t end = dot == std::string::npos || dot <= name ? path.size() : dot;
  return path.substr(0, end) + "_" + std::to_string(n) + path.substr(end);
}

/// Creates a file that was not there before. @returns its descriptor; sets `path` to its name.
int create(std::string& path) {
  const std::string wanted = path;
  for (int n = 1; n < kMostNames; ++n) {
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

struct Recorder::State {
  State(std::string wanted_path, double now) : path(std::move(wanted_path)), begin(now) {
    fd = create(path);
    filling.reserve(kCapacity);
    writing.reserve(kCapacity);
  }
  ~State() { ::close(fd); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  std::string path;
  const double begin;
  int fd = -1;

  std::mutex mutex;  // guards what follows
  std::condition_variable wake;
  std::vector<std::uint8_t> filling;
  std::string error;
  bool stop = false;

  std::vector<std::uint8_t> writing;  // of the thread alone
  std::thread thread;

  void fail(const std::string& why) { error = "the recording " + path + " has ended, " + why; }

  void add(Record& record, double now) {
    record.time = now - begin;
    const std::lock_guard<std::mutex> lock(mutex);
    if (!error.empty())
      return;
    if (filling.size() + kRecordHeaderSize + kLongestPayload > kCapacity) {
      fail("since the disk is too slow: record to another one");
      return;
    }
    append(record, filling);
    if (filling.size() > kCapacity / 2)
      wake.notify_one();
  }

  void run() {
    // Also for the signal of a file that is too large, whose default is to kill.
    sigset_t all;
    sigfillset(&all);
    ::pthread_sigmask(SIG_BLOCK, &all, nullptr);
    bool last = false;
    while (!last) {
      {
        std::unique_lock<std::mutex> lock(mutex);
        wake.wait_for(lock, kWriteInterval,
                      [this] { return stop || filling.size() > kCapacity / 2; });
        last = stop;
        filling.swap(writing);
      }
      const std::string why = write();
      writing.clear();
      if (!why.empty()) {
        const std::lock_guard<std::mutex> lock(mutex);
        fail(why);
        return;
      }
    }
  }

  /// @returns what went wrong; empty when nothing.
  std::string write() const {
    struct stat file {};
    if (::fstat(fd, &file) == 0 && file.st_nlink == 0)
      return "since somebody has deleted it: leave it in place while the driver runs";
    std::size_t done = 0;
    while (done < writing.size()) {
      const ssize_t size = ::write(fd, writing.data() + done, writing.size() - done);
      if (size < 0 && errno != EINTR)
        return std::string("since it cannot be written (") + std::strerror(errno) +
               "): make room on the disk or record to another one";
      if (size > 0)
        done += static_cast<std::size_t>(size);
    }
    return "";
  }
};

Recorder::Recorder(const std::string& path, double now, double wall_time)
    : state_(std::make_unique<State>(path, now)) {
  Header header;
  header.wall_time = wall_time;
  header.software = "wiimote_tracker_driver " WIIMOTE_TRACKER_DRIVER_VERSION;
  append(header, state_->filling);
  state_->thread = std::thread([this] { state_->run(); });
}

Recorder::~Recorder() {
  {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    state_->stop = true;
  }
  state_->wake.notify_one();
  state_->thread.join();
}

void Recorder::connected(const Remote& remote, double now) {
  Record record;
  record.kind = Record::Kind::kConnected;
  record.remote = remote;
  state_->add(record, now);
}

void Recorder::received(const protocol::Report& report, double now) {
  Record record;
  record.kind = Record::Kind::kReceived;
  record.report = report;
  state_->add(record, now);
}

void Recorder::sent(const protocol::Report& report, double now) {
  Record record;
  record.kind = Record::Kind::kSent;
  record.report = report;
  state_->add(record, now);
}

void Recorder::disconnected(const std::string& reason, double now) {
  Record record;
  record.kind = Record::Kind::kDisconnected;
  record.reason = reason;
  state_->add(record, now);
}

const std::string& Recorder::path() const {
  return state_->path;
}

std::string Recorder::error() const {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  return state_->error;
}

}  // namespace wiimote_tracker::recording
