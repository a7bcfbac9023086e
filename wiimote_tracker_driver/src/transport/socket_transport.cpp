#include "transport/socket_transport.h"

#include "file_descriptor.h"
#include "transport/users.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

namespace wiimote_tracker::transport {
namespace {

// How long the other side may take to say who it is [s].
constexpr double kGreetingTimeout = 1.0;
// What it says instead when somebody else has it; a process id follows.
const std::string kTaken = "taken by process ";

std::string nameOfVirtual(const Remote& remote) {
  return "the virtual Wii Remote at " + remote.description;
}

[[noreturn]] void throwSilent(const Remote& remote) {
  throw TransportError(nameOfVirtual(remote) + " does not answer: start it again");
}

class SocketTransport : public Transport {
 public:
  SocketTransport(FileDescriptor fd, Remote remote)
      : fd_(std::move(fd)), remote_(std::move(remote)) {}

  /// The first packet says who the remote is, or who has it. @throws DeviceTaken,
  /// TransportError.
  void receiveIdentity() {
    if (!waitReadable(kGreetingTimeout))
      throwSilent(remote_);
    char text[64];
    const ssize_t size = ::recv(fd_.get(), text, sizeof(text), 0);
    if (size <= 0)
      throwTaken(nameOfVirtual(remote_), std::nullopt);
    remote_.identity.assign(text, static_cast<std::size_t>(size));
    if (remote_.identity.compare(0, kTaken.size(), kTaken) == 0) {
      const auto user = static_cast<pid_t>(std::atoi(remote_.identity.c_str() + kTaken.size()));
      throwTaken(nameOfVirtual(remote_), user > 0 ? std::make_optional(user) : std::nullopt);
    }
  }

  bool read(protocol::Report& report, double timeout) override {
    if (!waitReadable(timeout))
      return false;
    const ssize_t size = ::recv(fd_.get(), report.bytes.data(), report.bytes.size(), MSG_DONTWAIT);
    if (size < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR))
      return false;
    if (size <= 0)
      throwDisconnected();
    report.size = static_cast<std::size_t>(size);
    return true;
  }

  void write(const protocol::Report& report) override {
    if (::send(fd_.get(), report.bytes.data(), report.size, MSG_NOSIGNAL | MSG_DONTWAIT) >= 0)
      return;
    if (errno == EAGAIN || errno == EWOULDBLOCK)
      throw Disconnected(nameOfVirtual(remote_) + " reads no reports any more: start it again");
    throwDisconnected();
  }

  Remote remote() const override { return remote_; }

 private:
  bool waitReadable(double timeout) const {
    pollfd fd{};
    fd.fd = fd_.get();
    fd.events = POLLIN;
    return ::poll(&fd, 1, static_cast<int>(std::ceil(timeout * 1e3))) > 0;
  }

  [[noreturn]] void throwDisconnected() const {
    throw Disconnected(nameOfVirtual(remote_) + " has gone away");
  }

  FileDescriptor fd_;
  Remote remote_;
};

}  // namespace

std::unique_ptr<Transport> openSocket(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof(address.sun_path))
    throw BadDeviceName("the socket path " + path + " is too long");
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);

  const Remote remote{"", "virtual:" + path};
  // One that hangs accepts nobody, and a blocking connect() would wait for it.
  FileDescriptor fd(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!fd.open())
    throw TransportError(std::string("cannot make a socket: ") + std::strerror(errno));
  if (::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    if (errno == EAGAIN)
      throwSilent(remote);
    if (errno == EACCES)
      throw PermissionDenied("permission denied on " + path +
                             ": run as the user who started the virtual Wii Remote");
    // Under roslaunch a relative path does not begin where the user started it.
    std::error_code ignored;
    const std::string where = std::filesystem::path(path).is_absolute()
                                  ? ""
                                  : " in " + std::filesystem::current_path(ignored).string();
    throw NoSuchDevice("no virtual Wii Remote listens at " + path + where +
                       ": start it (virtual_wiimote --socket) or correct the path");
  }
  auto transport = std::make_unique<SocketTransport>(std::move(fd), remote);
  transport->receiveIdentity();
  return transport;
}

}  // namespace wiimote_tracker::transport
