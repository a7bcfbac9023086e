#pragma once

#include "transport/transport.h"
#include "wiimote_tracker_driver/protocol/input_reports.h"

#include <functional>
#include <optional>
#include <string>

namespace wiimote_tracker::list_wiimotes {

/// Result of trying to talk to a remote. A driver that uses it is not disturbed, because only one
/// process can open a remote.
struct RemoteCheck {
  enum class State {
    kFree,    ///< Nobody has it, and it answers.
    kTaken,   ///< Another program has it; `sentence` says which.
    kFailed,  ///< `sentence` says why and what to do.
  };
  State state = State::kFailed;
  std::string sentence;
  std::string identity;                    ///< Of a free remote, as it reports.
  std::optional<protocol::Status> status;  ///< Of a free remote.
};

/// Opens the remote, asks for its status and closes it. Waits up to `timeout` [s] for the answer.
RemoteCheck checkRemote(const transport::DeviceName& device, double timeout);

/// Asks the remote for its status. Nothing if there is no answer within `timeout` [s].
/// @throws transport::Disconnected.
std::optional<protocol::Status> askStatus(transport::Transport& remote, double timeout);

/// Flashes all four player LEDs `number` times, then lights those of `leds` (LED 1..4 in bits
/// 0..3). `wait` waits for a time [s]. @throws transport::Disconnected.
void flash(transport::Transport& remote,
           int number,
           std::uint8_t leds,
           const std::function<void(double)>& wait);

}  // namespace wiimote_tracker::list_wiimotes
