#pragma once

#include "driver_parameters.h"
#include "image_stamper.h"
#include "recording/replay.h"
#include "transport/transport.h"
#include "wiimote_tracker_driver/protocol/input_reports.h"

#include <memory>
#include <optional>
#include <string>

namespace wiimote_tracker::driver {

/// The steady clock [s].
double steadyNow();

/// Source of reports and of time: a remote with the present time, or a recording with its own time.
/// Then both clocks show that, so that stamps do not depend on replay and speed. Not thread-safe.
class RemoteSource {
 public:
  /// The one that the parameters name. @throws ParameterError, naming `device_parameter`, when the
  /// recording cannot be played.
  RemoteSource(const DriverParameters& parameters, const std::string& device_parameter);

  /// As transport::Opener.
  std::unique_ptr<transport::Transport> open(bool delivered) {
    return replay_ ? replay_->open() : open_(delivered);
  }

  /// A clock that never goes back [s].
  double now() const { return replay_ ? replay_->now() : steadyNow(); }

  ClockReading readClocks() const;

  /// Lets up to `duration` [s] of a recording pass. @returns false when the caller has to wait.
  bool pass(double duration);

  /// The format of recorded images; nothing when the format can be chosen.
  std::optional<protocol::IrFormat> irFormat() const {
    return replay_ ? replay_->irFormat() : std::nullopt;
  }

  /// Whether the statuses are the remote's own.
  bool statusKnown() const { return !replay_ || replay_->statusKnown(); }

  /// Sentences for the user; empty when there are none.
  std::string notice() const { return replay_ ? replay_->notice() : ""; }

  /// Whether the source is a recording.
  bool recorded() const { return replay_.has_value(); }

 private:
  transport::Opener open_;  ///< Of a remote.
  std::optional<recording::Replay> replay_;
};

}  // namespace wiimote_tracker::driver
