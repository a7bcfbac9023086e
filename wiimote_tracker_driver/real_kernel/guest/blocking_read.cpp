#include "blocking_read.h"

#include "air/bytes.h"
#include "air/l2cap.h"
#include "clock.h"
#include "file_descriptor.h"

#include <sys/socket.h>
#include <sys/time.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <thread>

namespace wiimote_tracker::real_kernel {
namespace {

constexpr int kL2capProtocol = 0;
constexpr long kReadTime = 1;        // [s]
constexpr double kReadBegins = 0.3;  // [s] By the guest's clock, until the reader waits.

/// struct sockaddr_l2 of BlueZ's headers, which are not needed otherwise.
struct L2capAddress {
  sa_family_t family;
  std::uint16_t psm;
  std::uint8_t address[6];
  std::uint16_t channel;
  std::uint8_t address_type;
};

}  // namespace

bool readsLockTheSocket(const std::string& address) {
  const FileDescriptor socket(::socket(AF_BLUETOOTH, SOCK_SEQPACKET, kL2capProtocol));
  L2capAddress remote{};
  remote.family = AF_BLUETOOTH;
  remote.psm = kSdpPsm;
  const Address bytes = addressFrom(address);
  std::memcpy(remote.address, bytes.data(), bytes.size());
  if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&remote), sizeof(remote)) != 0)
    throw std::runtime_error("cannot connect to " + address + ": " + std::strerror(errno));
  const timeval timeout{kReadTime, 0};
  ::setsockopt(socket.get(), SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof(timeout));
  std::thread reader([&socket] {
    char byte;
    static_cast<void>(::recv(socket.get(), &byte, 1, 0));
  });
  sleepFor(kReadBegins);
  const double begin = now();
  ::listen(socket.get(), 1);  // is refused, but needs the lock
  const bool waited = now() - begin > 0.5 * (static_cast<double>(kReadTime) - kReadBegins);
  reader.join();
  return waited;
}

}  // namespace wiimote_tracker::real_kernel
