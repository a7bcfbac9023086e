#ifndef WIIMOTE_TRACKER_DRIVER_ROS_REMOTE_SOURCE_H
#define WIIMOTE_TRACKER_DRIVER_ROS_REMOTE_SOURCE_H

#include "clock_reading.h"
#include "driver_parameters.h"
#include "wiimote/wiimote.h"
#include "wiimote_tracker_driver/protocol/input_reports.h"

#include <memory>
#include <optional>
#include <string>

namespace wiimote_tracker::driver {

/// Source of reports and of time: a remote with the present time, or a recording with its own time.
/// Not thread-safe.
class RemoteSource {
 public:
  virtual ~RemoteSource() = default;

  /// As wiimote::Wiimote::Open.
  virtual std::unique_ptr<transport::Transport> open() = 0;

  /// A clock that never goes back [s].
  virtual double now() const = 0;

  virtual ClockReading readClocks() const = 0;

  /// Lets up to `duration` [s] of a recording pass. @returns false when the caller has to wait.
  virtual bool pass(double duration) = 0;

  /// The format of recorded images; nothing when the format can be chosen.
  virtual std::optional<protocol::IrFormat> irFormat() const { return std::nullopt; }

  /// Sentences for the user; empty when there are none.
  virtual std::string notice() const { return ""; }

  /// Whether the source is a recording.
  virtual bool recorded() const = 0;
};

/// The source that the parameters name. @throws ParameterError, naming `device_parameter`, when the
/// recording cannot be played.
std::unique_ptr<RemoteSource> makeSource(const DriverParameters& parameters,
                                         const std::string& device_parameter);

}  // namespace wiimote_tracker::driver

#endif  // WIIMOTE_TRACKER_DRIVER_ROS_REMOTE_SOURCE_H
