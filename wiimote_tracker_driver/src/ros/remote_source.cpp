#include "remote_source.h"

#include <wiimote_tracker_msgs/parameter_reader.h>

namespace wiimote_tracker::driver {

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
    return driver::readClocks();
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
