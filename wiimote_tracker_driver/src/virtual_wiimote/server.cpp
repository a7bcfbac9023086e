#include "wiimote_tracker_driver/virtual_wiimote/server.h"

#include "file_descriptor.h"
#include "virtual_wiimote/faulty_device.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

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

[[noreturn]] void fail(int error, const std::string& what) {
  throw std::system_error(error, std::generic_category(), what);
}

[[noreturn]] void failToListen(int error, const std::string& path) {
  fail(error, "a virtual Wii Remote cannot listen at '" + path +
                  "': choose a path in a directory that exists, where no other one listens");
}

sockaddr_un addressOf(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty())
    failToListen(EINVAL, path);
  if (path.size() >= sizeof(address.sun_path))
    failToListen(ENAMETOOLONG, path);
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  return address;
}

/// Removes a socket file without a listener.
void removeStale(const std::string& path, const sockaddr_un& address) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0 || !S_ISSOCK(info.st_mode))
    return;
  const FileDescriptor probe(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  const int result =
      ::connect(probe.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address));
  if (result != 0 && errno == ECONNREFUSED)
    ::unlink(path.c_str());
}

FileDescriptor listenAt(const std::string& path) {
  const sockaddr_un address = addressOf(path);
  removeStale(path, address);
  FileDescriptor fd(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!fd.open())
    fail(errno, "socket");
  // Only the owner may connect; nobody can before listen().
  if (::bind(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0 ||
      ::chmod(path.c_str(), S_IRUSR | S_IWUSR) != 0 || ::listen(fd.get(), 4) != 0)
    failToListen(errno, path);
  return fd;
}

}  // namespace

struct Server::State {
  State(Server& server_to_run, std::string socket_path, std::string device_identity)
      : server(server_to_run),
        path(std::move(socket_path)),
        identity(std::move(device_identity)),
        wake(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    if (!wake.open())
      fail(errno, "eventfd");
    listener = listenAt(path);
  }

  Server& server;
  const std::string path;
  const std::string identity;
  const FileDescriptor wake;
  FileDescriptor listener;  ///< Guarded by the server's mutex, as is `host`.
  FileDescriptor host;
  std::atomic<bool> stop{false};
  std::thread thread;

  void wakeUp() const { ::eventfd_write(wake.get(), 1); }

  // As with a real remote, a host that does not read loses reports.
  void send(const Bytes& report) const {
    ::send(host.get(), report.data(), report.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
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
    FileDescriptor fd(::accept4(listener.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (!fd.open())
      return;
    if (host.open()) {
      refuse(fd.get());
      return;
    }
    host = std::move(fd);
    send(Bytes(identity.begin(), identity.end()));
  }

  void receive() {
    std::array<std::uint8_t, 64> buffer{};
    for (;;) {
      const ssize_t size = ::recv(host.get(), buffer.data(), buffer.size(), MSG_DONTWAIT);
      if (size < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR))
        return;
      // Reported once if the host left with unread reports; its last reports still follow.
      if (size < 0 && errno == ECONNRESET)
        continue;
      if (size <= 0) {
        host.reset();
        return;
      }
      server.send(server.device_->handleOutput(Bytes(buffer.begin(), buffer.begin() + size)));
    }
  }

  void run() {
    while (!stop) {
      std::array<pollfd, 3> fds{};
      {
        const std::lock_guard<std::mutex> lock(server.mutex_);
        fds[0].fd = wake.get();
        fds[1].fd = listener.get();  // poll ignores a negative fd
        fds[2].fd = host.get();
      }
      for (pollfd& fd : fds)
        fd.events = POLLIN;
      if (::poll(fds.data(), fds.size(), -1) < 0)
        continue;
      if (fds[0].revents != 0) {
        eventfd_t count = 0;
        ::eventfd_read(wake.get(), &count);
      }
      // The state may have changed during poll(), but these calls never block.
      const std::lock_guard<std::mutex> lock(server.mutex_);
      if (host.open())
        receive();
      if (listener.open())
        accept();
    }
  }
};

Server::Server(const std::string& path, const std::string& identity, const Device::Options& options)
    : HostedDevice(options, true), state_(std::make_unique<State>(*this, path, identity)) {
  state_->thread = std::thread([this] { state_->run(); });
}

Server::~Server() {
  state_->stop = true;
  state_->wakeUp();
  state_->thread.join();
  if (state_->listener.open())
    ::unlink(state_->path.c_str());
}

bool Server::connected() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return state_->host.open();
}

void Server::send(const std::vector<Bytes>& reports) {
  if (!state_->host.open())
    return;
  for (const Bytes& report : reports)
    state_->send(report);
}

void Server::setReachable(bool reachable) {
  if (reachable == state_->listener.open())
    return;
  if (reachable) {
    state_->listener = listenAt(state_->path);
  } else {
    ::unlink(state_->path.c_str());
    state_->listener.reset();
    state_->host.reset();
  }
  state_->wakeUp();
}

}  // namespace wiimote_tracker::virtual_wiimote
