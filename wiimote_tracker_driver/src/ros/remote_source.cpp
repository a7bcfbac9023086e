#include "remote_source.h"

#include <wiimote_tracker_msgs/parameter_reader.h>

#include <chrono>
#include <limits>

namespace wiimote_tracker::driver {
namespace {

// Readings up to this long were certainly not interrupted [s].
constexpr double kUninterrupted = 1e-5;
constexpr int kAttempts = 3;

/// Of the present time.
ClockReading readPresent() {
  ClockReading reading;
  reading.steady = steadyNow();
  reading.simulated = ros::Time::isSimTime();
  if (reading.simulated) {
    reading.ros = ros::Time::now();
    return reading;
  }
  reading.uncertainty = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kAttempts && reading.uncertainty > kUninterrupted; ++i) {
    const double before = steadyNow();
    const ros::Time ros = ros::Time::now();
    const double after = steadyNow();
    if (after - before < reading.uncertainty) {
      reading.uncertainty = after - before;
      reading.ros = ros - ros::Duration(0.5 * (before + after) - reading.steady);
    }
  }
  return reading;
}

}  // namespace

double steadyNow() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

RemoteSource::RemoteSource(const DriverParameters& parameters,
                           const std::string& device_parameter) {
  const transport::DeviceName& name = parameters.device;
  if (name.kind != transport::DeviceName::Kind::kReplay) {
    open_ = transport::opener(name);
    return;
  }
  const double rate = parameters.replay_rate;
  try {
    replay_.emplace(name.value, rate > 0.0 ? recording::realTime(rate) : recording::Pace());
  } catch (const recording::BadRecording& e) {
    throw ParameterError(device_parameter + ": " + e.what());
  }
}

ClockReading RemoteSource::readClocks() const {
  if (!replay_)
    return readPresent();
  ClockReading reading;
  reading.steady = replay_->now();
  reading.ros = ros::Time(replay_->wallTime());
  return reading;
}

bool RemoteSource::pass(double duration) {
  if (!replay_ || replay_->ended())
    return false;
  replay_->pass(duration);
  return true;
}

}  // namespace wiimote_tracker::driver
