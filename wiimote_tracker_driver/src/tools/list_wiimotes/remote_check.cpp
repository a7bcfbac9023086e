#include "remote_check.h"

#include "wiimote_tracker_driver/protocol/output_reports.h"

#include <chrono>

namespace wiimote_tracker::list_wiimotes {
namespace {

constexpr std::uint8_t kAllLeds = 0xf;
constexpr double kLit = 0.2;    // [s]
constexpr double kDark = 0.3;   // [s]
constexpr double kPause = 0.6;  // [s] Before and after, to separate the flashes.

}  // namespace

std::optional<protocol::Status> askStatus(transport::Transport& remote, double timeout) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(timeout);
  remote.write(protocol::requestStatus());
  // Other answers and data reports may come first.
  for (;;) {
    const double left = std::chrono::duration<double>(end - Clock::now()).count();
    if (left <= 0.0)
      return std::nullopt;
    protocol::Report report;
    if (!remote.read(report, left))
      continue;
    if (const auto status = protocol::decodeStatus(report))
      return status;
  }
}

RemoteCheck checkRemote(const transport::DeviceName& device, double timeout) {
  RemoteCheck check;
  try {
    const auto remote = transport::open(device);
    check.identity = remote->remote().identity;
    check.status = askStatus(*remote, timeout);
    if (check.status)
      check.state = RemoteCheck::State::kFree;
    else
      check.sentence = "it does not answer: take its batteries out and put them back";
  } catch (const transport::DeviceTaken& e) {
    check.state = RemoteCheck::State::kTaken;
    check.sentence = e.what();
  } catch (const transport::TransportError& e) {
    check.sentence = e.what();
  }
  return check;
}

void flash(transport::Transport& remote,
           int number,
           std::uint8_t leds,
           const std::function<void(double)>& wait) {
  remote.write(protocol::setLeds(0));
  wait(kPause);
  for (int i = 0; i < number; ++i) {
    remote.write(protocol::setLeds(kAllLeds));
    wait(kLit);
    remote.write(protocol::setLeds(0));
    wait(kDark);
  }
  wait(kPause);
  remote.write(protocol::setLeds(leds));
}

}  // namespace wiimote_tracker::list_wiimotes
