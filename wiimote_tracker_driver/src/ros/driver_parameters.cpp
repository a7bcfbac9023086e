#include "driver_parameters.h"

#include "transport/transport.h"

#include <wiimote_tracker_msgs/parameter_reader.h>

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

// Checks what a range cannot express.
void check(const DriverParameters& p, const ros::NodeHandle& private_nh) {
  transport::DeviceName device;
  try {
    device = transport::parseDeviceName(p.device);
  } catch (const transport::BadDeviceName& e) {
    throw ParameterError(private_nh.resolveName("device") + ": " + e.what());
  }
  if (device.kind == transport::DeviceName::Kind::kReplay && !p.record.empty())
    throw ParameterError(private_nh.resolveName("record") +
                         " is set, but a replay is not recorded again: leave it empty, or name a "
                         "remote as the device");
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
  declareParameters(reader, p);
  reader.bounded("diagnostic_period", 1.0, 0.1, 3600.0);  // used by diagnostic_updater
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
                                "' is not a sensitivity: choose wii_1 to wii_5, marcan, "
                                "max or custom");
  if (block1.empty() || block2.empty())
    throw std::invalid_argument(
        "the sensitivity custom needs both of its blocks, such as '07 00 00 71 01 00 72 00 20' and "
        "'1f 03'");
  return protocol::parseIrSensitivity(block1 + " / " + block2);
}

std::uint8_t playerLeds(const std::string& camera_name) {
  // By the last digit. Each pattern has the fewest LEDs that add up to the number, with LED 4.
  constexpr std::array<std::uint8_t, 10> kPatterns{0xf, 0x1, 0x2, 0x4, 0x8,
                                                   0x9, 0xa, 0xc, 0xd, 0xe};
  if (camera_name.empty() || std::isdigit(static_cast<unsigned char>(camera_name.back())) == 0)
    return kPatterns[1];
  return kPatterns[static_cast<std::size_t>(camera_name.back() - '0')];
}

std::uint8_t leds(int leds, const std::string& camera_name) {
  return leds < 0 ? playerLeds(camera_name) : static_cast<std::uint8_t>(leds);
}

}  // namespace wiimote_tracker::driver
