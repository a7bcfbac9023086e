#include "remote_source.h"

#include "recording/recorder.h"
#include "recording/replay.h"
#include "transport/transport.h"

#include <wiimote_tracker_msgs/parameter_reader.h>

namespace wiimote_tracker::driver {
namespace {

class LiveRemote : public RemoteSource {
 public:
  explicit LiveRemote(const transport::DeviceName& name) : open_(transport::opener(name)) {}

  std::unique_ptr<transport::Transport> open() override { return open_(); }
  double now() const override { return steadyNow(); }
  ClockReading readClocks() const override { return driver::readClocks(); }
  bool pass(double) override { return false; }
  bool recorded() const override { return false; }

 private:
  const std::function<std::unique_ptr<transport::Transport>()> open_;
};

// Both clocks show the recording's time, so that stamps do not depend on replay and speed.
class RecordedRemote : public RemoteSource {
 public:
  RecordedRemote(const std::string& file, double rate)
      : replay_(file, rate > 0.0 ? recording::realTime(rate) : recording::Pace()) {}

  std::unique_ptr<transport::Transport> open() override { return replay_.open(); }
  double now() const override { return replay_.now(); }
  ClockReading readClocks() const override {
    ClockReading reading;
    reading.steady = replay_.now();
    reading.ros = ros::Time(replay_.wallTime());
    return reading;
  }
  bool pass(double duration) override {
    if (replay_.ended())
      return false;
    replay_.pass(duration);
    return true;
  }
  std::optional<protocol::IrFormat> irFormat() const override { return replay_.irFormat(); }
  std::string notice() const override { return replay_.notice(); }
  bool recorded() const override { return true; }

 private:
  recording::Replay replay_;
};

}  // namespace

std::unique_ptr<RemoteSource> makeSource(const DriverParameters& parameters,
                                         const std::string& device_parameter) {
  const transport::DeviceName name = transport::parseDeviceName(parameters.device);
  if (name.kind != transport::DeviceName::Kind::kReplay)
    return std::make_unique<LiveRemote>(name);
  try {
    return std::make_unique<RecordedRemote>(name.value, parameters.replay_rate);
  } catch (const recording::BadRecording& e) {
    throw ParameterError(device_parameter + ": " + e.what());
  }
}

}  // namespace wiimote_tracker::driver
