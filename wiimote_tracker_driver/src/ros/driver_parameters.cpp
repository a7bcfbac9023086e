#include "driver_parameters.h"

#include <wiimote_tracker_msgs/text.h>

#include <array>
#include <cctype>
#include <cstddef>
#include <stdexcept>

namespace wiimote_tracker::driver {
namespace {

// A slower replay would delay the end of the driver.
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

protocol::IrFormat irFormat(const std::string& ir_mode) {
  if (ir_mode == "basic")
    return protocol::IrFormat::kBasic;
  return ir_mode == "full" ? protocol::IrFormat::kFull : protocol::IrFormat::kExtended;
}

// Reads what is named, and checks what a range cannot express.
void interpret(const std::string& device, const ParameterReader& reader, DriverParameters& p) {
  try {
    p.device = transport::parseDeviceName(device);
  } catch (const transport::BadDeviceName& e) {
    throw ParameterError(reader.nameOf("device") + ": " + e.what());
  }
  if (p.device.kind == transport::DeviceName::Kind::kReplay && !p.record.empty())
    throw ParameterError(reader.nameOf("record") +
                         " is set, but a replay is not recorded again: leave it empty, or name a "
                         "remote as the device");
  if (p.replay_rate > 0.0 && p.replay_rate < kSlowestReplay)
    throw ParameterError(reader.nameOf("replay_rate") +
                         " must be 0 (as fast as possible) or at least 0.1");
  if (!isCameraName(p.camera_name))
    throw ParameterError(reader.nameOf("camera_name") + " is '" + p.camera_name +
                         "', but must consist of letters, digits and underscores");
  try {
    p.remote.sensitivity =
        sensitivity(p.ir_sensitivity, p.ir_sensitivity_block1, p.ir_sensitivity_block2);
  } catch (const std::invalid_argument& e) {
    throw ParameterError(reader.nameOf("ir_sensitivity_block1") + " and _block2: " + e.what());
  }
  p.remote.leds = leds(p.leds, p.camera_name);
}

}  // namespace

DriverParameters readDriverParameters(ParameterReader* reader, const std::string& name_space) {
  DriverParameters p;
  const auto device = reader->optional<std::string>("device", "");
  reader->read("camera_name", &p.camera_name);
  reader->read("camera_info_url", &p.camera_info_url);
  reader->read("latency", &p.stamper.latency, 0.0, 1.0);
  reader->read("estimate_exposure", &p.stamper.estimate);
  p.remote.ir_format =
      irFormat(reader->choice("ir_mode", "extended", {"basic", "extended", "full"}));
  p.ir_sensitivity = reader->choice("ir_sensitivity", p.ir_sensitivity, sensitivityNames());
  reader->read("ir_sensitivity_block1", &p.ir_sensitivity_block1);
  reader->read("ir_sensitivity_block2", &p.ir_sensitivity_block2);
  reader->read("leds", &p.leds, -1, 15);
  reader->read("battery_low", &p.battery_low, 0.0, 1.0);
  reader->read("rumble_max", &p.rumble_max, 0.0, 10.0);
  reader->read("linear_acceleration_stddev", &p.linear_acceleration_stddev, 1e-6, 100.0);
  reader->read("record", &p.record);
  reader->read("replay_rate", &p.replay_rate, 0.0, 1000.0);
  reader->read("realtime_priority", &p.realtime_priority, 0, 99);
  reader->read("reply_timeout", &p.remote.reply_timeout, 0.05, 10.0);
  reader->read("silence_timeout", &p.remote.silence_timeout, 0.1, 60.0);
  reader->read("status_interval", &p.remote.status_interval, 1.0, 86400.0);
  reader->bounded("diagnostic_period", 1.0, 0.1, 3600.0);  // used by diagnostic_updater
  reader->refuseUnknown();
  if (p.camera_name.empty())
    p.camera_name = lastPart(name_space);
  interpret(device, *reader, p);
  return p;
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
    throw std::invalid_argument("'" + name + "' is not a sensitivity: choose one of " +
                                joined(sensitivityNames()));
  if (block1.empty() || block2.empty())
    throw std::invalid_argument(
        "the sensitivity custom needs both of its blocks, such as '07 00 00 71 01 00 72 00 20' and "
        "'1f 03'");
  return protocol::parseIrSensitivity(block1 + " / " + block2);
}

std::uint8_t leds(int leds, const std::string& camera_name) {
  if (leds >= 0)
    return static_cast<std::uint8_t>(leds);
  // By the last digit. Each pattern has the fewest LEDs that add up to the number, with LED 4.
  constexpr std::array<std::uint8_t, 10> kPatterns{0xf, 0x1, 0x2, 0x4, 0x8,
                                                   0x9, 0xa, 0xc, 0xd, 0xe};
  if (camera_name.empty() || std::isdigit(static_cast<unsigned char>(camera_name.back())) == 0)
    return kPatterns[1];
  return kPatterns[static_cast<std::size_t>(camera_name.back() - '0')];
}

}  // namespace wiimote_tracker::driver
