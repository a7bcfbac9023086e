#include "scenarios.h"

#include "air/air.h"
#include "air/bytes.h"
#include "air/l2cap.h"
#include "bluez.h"
#include "clock.h"
#include "file_descriptor.h"
#include "kernel.h"
#include "plugged_remote.h"
#include "process.h"
#include "streaming.h"

#include <sys/socket.h>
#include <sys/time.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>

namespace wiimote_tracker::real_kernel {
namespace {

constexpr double kClientStart = 20.0;    // [s] For Python and the library.
constexpr double kClientDuration = 3.0;  // [s]
constexpr int kImages = 270;             // In that time: 90 a second.

/// "x,y x,y ..." as an image without sizes.
protocol::DataReport imageFrom(const std::string& line) {
  protocol::DataReport image;
  image.ir_format = protocol::IrFormat::kBasic;
  std::istringstream words(line);
  for (protocol::IrSpot& spot : image.spots) {
    std::string word;
    words >> word;
    int x = 0, y = 0;
    spot.seen = std::sscanf(word.c_str(), "%d,%d", &x, &y) == 2;
    spot.x = static_cast<decltype(spot.x)>(x);
    spot.y = static_cast<decltype(spot.y)>(y);
  }
  return image;
}

/// Checks the images that a client prints once it has begun. `tolerance`: of the lights [px].
void checkImages(Checks& checks, const Process& client, const Scene& scene, int tolerance) {
  waitFor([&] { return client.output().find(',') != std::string::npos; }, kClientStart);
  const std::size_t begin = client.output().size();
  sleepFor(kClientDuration);
  std::istringstream lines(client.output().substr(begin));
  int images = 0, wrong = 0;
  std::string first_wrong;
  std::string line;
  std::getline(lines, line);  // may be cut off
  while (std::getline(lines, line) && !lines.eof()) {
    ++images;
    if (!scene.frameOf(imageFrom(line), tolerance) && wrong++ == 0)
      first_wrong = line;
  }
  checks.check("3 s at 90 Hz or more", images >= kImages,
               std::to_string(images) + " images" + (images == 0 ? ": " + client.output() : ""));
  checks.check("each shows the lights of a frame", images > 0 && wrong == 0,
               std::to_string(wrong) + " wrong" + (wrong > 0 ? ": " + first_wrong : ""));
}

/// struct sockaddr_l2 of BlueZ's headers, which are not needed otherwise.
struct L2capAddress {
  sa_family_t family;
  std::uint16_t psm;
  std::uint8_t address[6];
  std::uint16_t channel;
  std::uint8_t address_type;
};

/// Whether a program that waits in a read of a Bluetooth socket keeps that socket locked. Then the
/// kernel can deliver nothing more, to any socket: so in Linux 5.10.223 (Debian 11), which has
/// "Bluetooth: af_bluetooth: Fix Use-After-Free in bt_sock_recvmsg" without the later "Fix
/// deadlock". @param address of a remote that can be connected to
/// @throws std::runtime_error if it cannot.
bool readsLockTheSocket(const std::string& address) {
  constexpr int kL2capProtocol = 0;
  constexpr long kReadTime = 1;        // [s]
  constexpr double kReadBegins = 0.3;  // [s] By the guest's clock, until the reader waits.
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

}  // namespace

void xwiimoteClient(Checks& checks) {
  Scene scene;
  const PluggedRemote remote(kAddress, scene);
  waitFor([] { return !hidrawOf(kAddress).empty(); }, kTimeout);
  sleepFor(kSetUpTime);
  const Process client({"xwiimote_client", sysfsPathOf(kAddress)});
  constexpr int kFuzz = 2;  // [px] The kernel smooths this input device's axes by so much.
  checkImages(checks, client, scene, kFuzz);
}

void cwiidClient(Checks& checks) {
  Scene scene;
  Air air;
  air.addRemote(kAddress, scene);
  air.addAdapter("00:1a:7d:00:00:01");
  const Bluez bluez;  // switches the adapter on
  sleepFor(kSetUpTime);
  air.press(kAddress, Press::kOneAndTwo);
  if (readsLockTheSocket(kAddress))
    return checks.skip("images of libcwiid",
                       "in this kernel a waiting read of a Bluetooth socket stops all others");
  const Process client({"cwiid_client", kAddress});
  checkImages(checks, client, scene, 0);
}

}  // namespace wiimote_tracker::real_kernel
