#ifndef WIIMOTE_TRACKER_DRIVER_ROS_REMOTE_SOURCE_H
#define WIIMOTE_TRACKER_DRIVER_ROS_REMOTE_SOURCE_H

#include "clock_reading.h"
#include "driver_parameters.h"
#include "wiimote_tracker_driver/protocol/input_reports.h"
#include "wiimote_tracker_driver/wiimote/wiimote.h"

#include <memory>
#include <optional>
#include <string>

namespace wiimote_tracker::driver {

/// Where reports come from, and the time in which they come: a remote in the present, or a
/// recording in the time when it was made. Not thread-safe but for what is said so.
class RemoteSource {
 public:
  virtual ~RemoteSource() = default;

  /// As wiimote::Wiimote::Open.
  virtual std::unique_ptr<transport::Transport> open() = 0;

  /// A clock that never goes back [s].
  virtual double now() const = 0;

  virtual ClockReading readClocks() const = 0;

  /// Lets up to `duration` [s] pass. @returns false when the caller has to wait that long himself.
  virtual bool pass(double duration) = 0;

  /// When images can come in one format only, which nobody can choose.
  virtual std::optional<protocol::IrFormat> irFormat() const { return std::nullopt; }

  /// What people should know, in sentences; empty when there is nothing.
  virtual std::string notice() const { return ""; }

  /// Whether the source is a recording.
  virtual bool recorded() const = 0;
};

/// What the parameters name. @throws ParameterError, naming `device_parameter`, when the recording
/// cannot be played.
std::unique_ptr<RemoteSource> makeSource(const DriverParameters& parameters,
                                         const std::string& device_parameter);

}  // namespace wiimote_tracker::driver

#endif  // WIIMOTE_TRACKER_DRIVER_ROS_REMOTE_SOURCE_H
