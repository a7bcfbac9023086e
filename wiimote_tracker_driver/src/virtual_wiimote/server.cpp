#include "wiimote_tracker_driver/virtual_wiimote/server.h"

#include "wiimote_tracker_driver/virtual_wiimote/faulty_device.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

namespace wiimote_tracker::virtual_wiimote {
namespace {

constexpr std::uint8_t kFirstDataReport = 0x30;

class FileDescriptor {
 public:
  explicit FileDescriptor(int fd = -1) : fd_(fd) {}
  ~FileDescriptor() { reset(); }
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;

  int get() const { return fd_; }
  bool open() const { return fd_ >= 0; }
  void reset(int fd = -1) {
    if (fd_ >= 0)
      ::close(fd_);
    fd_ = fd;
  }

 private:
  int fd_;
};

[[noreturn]] void fail(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

sockaddr_un addressOf(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof(address.sun_path)) {
    errno = path.empty() ? EINVAL : ENAMETOOLONG;
    fail("a virtual Wii Remote cannot listen at '" + path +
         "': choose a path in a directory that exists, where no other one listens");
  }
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  return address;
}

/// Removes a socket file that nobody listens at.
void removeStale(const std::string& path, const sockaddr_un& address) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0 || !S_ISSOCK(info.st_mode))
    return;
  const FileDescriptor probe(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
  const int result =
      ::connect(probe.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address));
  if (result != 0 && errno == ECONNREFUSED)
    ::unlink(path.c_str());
}

int listenAt(const std::string& path) {
  const sockaddr_un address = addressOf(path);
  removeStale(path, address);
  const int fd = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0)
    fail("socket");
  if (::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0 ||
      ::listen(fd, 4) != 0) {
    const int error = errno;
    ::close(fd);
    errno = error;
    fail("a virtual Wii Remote cannot listen at '" + path +
         "': choose a path in a directory that exists, where no other one listens");
  }
  return fd;
}

}  // namespace

struct Server::State {
  State(std::string socket_path, std::string device_identity, const Device::Options& options)
      : path(std::move(socket_path)), identity(std::move(device_identity)), device(options) {}

  const std::string path;
  const std::string identity;
  FileDescriptor wake;

  mutable std::mutex mutex;  // guards all below
  FaultyDevice device;
  bool present = true;  ///< As told; a fault may take it away all the same.
  FileDescriptor listener;
  FileDescriptor host;

  std::atomic<bool> stop{false};
  std::thread thread;

  void wakeUp() const {
    const std::uint64_t one = 1;
    if (::write(wake.get(), &one, sizeof(one)) < 0) {
      // The counter is full: the thread is being woken already.
    }
  }

  // A host that does not read loses reports, as with a real remote.
  void send(const Bytes& report) const {
    ::send(host.get(), report.data(), report.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  }

  void send(const std::vector<Bytes>& reports) const {
    if (!host.open())
      return;
    for (const Bytes& report : reports)
      send(report);
  }

  /// Lets hosts reach the device, or not.
  void setReachable(bool reachable) {
    if (reachable == listener.open())
      return;
    if (reachable) {
      listener.reset(listenAt(path));
    } else {
      ::unlink(path.c_str());
      listener.reset();
      host.reset();
    }
    wakeUp();
  }

  /// Tells a second host who the first one is.
  void refuse(int second) const {
    ucred first{};
    socklen_t size = sizeof(first);
    if (::getsockopt(host.get(), SOL_SOCKET, SO_PEERCRED, &first, &size) != 0)
      return;
    const std::string text = "taken by process " + std::to_string(first.pid);
    ::send(second, text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  }

  void accept() {
    const int fd = ::accept4(listener.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (fd < 0)
      return;
    if (host.open()) {
      refuse(fd);
      ::close(fd);
      return;
    }
    host.reset(fd);
    send(Bytes(identity.begin(), identity.end()));
  }

  void receive() {
    std::array<std::uint8_t, 64> buffer{};
    for (;;) {
      const ssize_t size = ::recv(host.get(), buffer.data(), buffer.size(), MSG_DONTWAIT);
      if (size < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR))
        return;
      // Told once when the host left with reports unread; what it had written still follows.
      if (size < 0 && errno == ECONNRESET)
        continue;
      if (size <= 0) {
        host.reset();
        return;
      }
      send(device.handleOutput(Bytes(buffer.begin(), buffer.begin() + size)));
    }
  }

  void run() {
    while (!stop) {
      std::array<pollfd, 3> fds{};
      {
        const std::lock_guard<std::mutex> lock(mutex);
        fds[0].fd = wake.get();
        fds[1].fd = listener.get();  // a negative fd is ignored by poll
        fds[2].fd = host.get();
      }
      for (pollfd& fd : fds)
        fd.events = POLLIN;
      if (::poll(fds.data(), fds.size(), -1) < 0)
        continue;
      if (fds[0].revents != 0) {
        std::uint64_t count = 0;
        if (::read(wake.get(), &count, sizeof(count)) < 0) {
          // Somebody else's wake-up was consumed together with this one.
        }
      }
      // Whatever changed while polling, these read what there is and never block.
      const std::lock_guard<std::mutex> lock(mutex);
      if (host.open())
        receive();
      if (listener.open())
        accept();
    }
  }
};

Server::Server(const std::string& path, const std::string& identity, const Device::Options& options)
    : state_(std::make_unique<State>(path, identity, options)) {
  state_->wake.reset(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (!state_->wake.open())
    fail("eventfd");
  state_->listener.reset(listenAt(path));
  state_->thread = std::thread([this] { state_->run(); });
}

Server::~Server() {
  state_->stop = true;
  state_->wakeUp();
  state_->thread.join();
  if (state_->listener.open())
    ::unlink(state_->path.c_str());
}

bool Server::sample(const Senses& senses) {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  if (!state_->present)
    return false;
  const std::vector<Bytes> reports = state_->device.sample(senses);
  state_->setReachable(!state_->device.away());
  state_->send(reports);
  return std::any_of(reports.begin(), reports.end(),
                     [](const Bytes& report) { return report.at(0) >= kFirstDataReport; });
}

void Server::setFaults(const Faults& faults) {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  state_->device.setFaults(faults);
}

void Server::setNunchuk(bool plugged) {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  state_->send(state_->device.setNunchuk(plugged));
}

void Server::setBattery(std::uint8_t level) {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  state_->device.device().setBattery(level);
}

bool Server::connected() const {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  return state_->host.open();
}

std::uint8_t Server::leds() const {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  return state_->device.device().leds();
}

bool Server::rumble() const {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  return state_->device.device().rumble();
}

void Server::setPresent(bool present) {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  if (present == state_->present)
    return;
  if (present)
    state_->device.powerCycle();
  state_->setReachable(present);
  state_->present = present;
}

}  // namespace wiimote_tracker::virtual_wiimote
