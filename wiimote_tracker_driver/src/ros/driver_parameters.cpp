#include "driver_parameters.h"

#include "player_leds.h"
#include "wiimote_tracker_driver/transport/transport.h"

#include <wiimote_tracker_msgs/parameter_reader.h>

#include <cctype>
#include <stdexcept>

namespace wiimote_tracker::driver {
namespace {

// Slower, and the driver would take long to notice that it is to stop.
constexpr double kSlowestReplay = 0.1;
constexpr const char* kCustom = "custom";

bool isCameraName(const std::string& name) {
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_')
      return false;
  }
  return !name.empty();
}

std::string lastPart(const std::string& name_space) {
  const std::string name = name_space.substr(name_space.rfind('/') + 1);
  return name.empty() ? "wiimote" : name;
}

// What no range can tell.
void check(const DriverParameters& p, const ros::NodeHandle& private_nh) {
  transport::DeviceName device;
  try {
    device = transport::parseDeviceName(p.device);
  } catch (const transport::BadDeviceName& e) {
    throw ParameterError(private_nh.resolveName("device") + ": " + e.what());
  }
  if (device.kind == transport::DeviceName::Kind::kReplay && !p.record.empty())
    throw ParameterError(private_nh.resolveName("record") +
                         " is set, but a recording that is played is not recorded again: leave it "
                         "empty, or name a remote as the device");
  if (p.replay_rate > 0.0 && p.replay_rate < kSlowestReplay)
    throw ParameterError(private_nh.resolveName("replay_rate") +
                         " must be 0 (as fast as possible) or at least 0.1");
  if (!isCameraName(p.camera_name))
    throw ParameterError(private_nh.resolveName("camera_name") + " is '" + p.camera_name +
                         "', but must consist of letters, digits and underscores");
  try {
    sensitivity(p.ir_sensitivity, p.ir_sensitivity_block1, p.ir_sensitivity_block2);
  } catch (const std::invalid_argument& e) {
    throw ParameterError(private_nh.resolveName("ir_sensitivity_block1") +
                         " and _block2: " + e.what());
  }
}

}  // namespace

DriverParameters readDriverParameters(const ros::NodeHandle& nh,
                                      const ros::NodeHandle& private_nh) {
  ParameterReader reader(private_nh);
  DriverParameters p;
  p.device = reader.optional("device", p.device);
  p.camera_name = reader.optional("camera_name", p.camera_name);
  p.camera_info_url = reader.optional("camera_info_url", p.camera_info_url);
  p.latency = reader.bounded("latency", p.latency, 0.0, 1.0);
  p.estimate_exposure = reader.optional("estimate_exposure", p.estimate_exposure);
  p.ir_mode = reader.choice("ir_mode", p.ir_mode, {"basic", "extended", "full"});
  p.ir_sensitivity = reader.choice("ir_sensitivity", p.ir_sensitivity, sensitivityNames());
  p.ir_sensitivity_block1 = reader.optional("ir_sensitivity_block1", p.ir_sensitivity_block1);
  p.ir_sensitivity_block2 = reader.optional("ir_sensitivity_block2", p.ir_sensitivity_block2);
  p.leds = reader.bounded("leds", p.leds, -1, 15);
  p.battery_low = reader.bounded("battery_low", p.battery_low, 0.0, 1.0);
  p.rumble_max = reader.bounded("rumble_max", p.rumble_max, 0.0, 10.0);
  p.linear_acceleration_stddev =
      reader.bounded("linear_acceleration_stddev", p.linear_acceleration_stddev, 1e-6, 100.0);
  p.record = reader.optional("record", p.record);
  p.replay_rate = reader.bounded("replay_rate", p.replay_rate, 0.0, 1000.0);
  p.realtime_priority = reader.bounded("realtime_priority", p.realtime_priority, 0, 99);
  p.reply_timeout = reader.bounded("reply_timeout", p.reply_timeout, 0.05, 10.0);
  p.silence_timeout = reader.bounded("silence_timeout", p.silence_timeout, 0.1, 60.0);
  p.status_interval = reader.bounded("status_interval", p.status_interval, 1.0, 86400.0);
  reader.allow("diagnostic_period");  // diagnostic_updater's own
  reader.refuseUnknown();
  if (p.camera_name.empty())
    p.camera_name = lastPart(nh.getNamespace());
  check(p, private_nh);
  return p;
}

protocol::IrFormat irFormat(const std::string& ir_mode) {
  if (ir_mode == "basic")
    return protocol::IrFormat::kBasic;
  return ir_mode == "full" ? protocol::IrFormat::kFull : protocol::IrFormat::kExtended;
}

std::vector<std::string> sensitivityNames() {
  std::vector<std::string> names = protocol::irSensitivityNames();
  names.push_back(kCustom);
  return names;
}

protocol::IrSensitivity sensitivity(const std::string& name,
                                    const std::string& block1,
                                    const std::string& block2) {
  if (const auto known = protocol::irSensitivity(name))
    return *known;
  if (name != kCustom)
    throw std::invalid_argument("'" + name +
                                "' is no sensitivity: choose wii_1 to wii_5, marcan, "
                                "max or custom");
  if (block1.empty() || block2.empty())
    throw std::invalid_argument(
        "the sensitivity custom needs both of its blocks, such as '07 00 00 71 01 00 72 00 20' and "
        "'1f 03'");
  return protocol::parseIrSensitivity(block1 + " / " + block2);
}

std::uint8_t leds(int leds, const std::string& camera_name) {
  return leds < 0 ? playerLeds(camera_name) : static_cast<std::uint8_t>(leds);
}

}  // namespace wiimote_tracker::driver
