#pragma once

#include "image_stamper.h"
#include "transport/transport.h"
#include "wiimote/options.h"
#include "wiimote_tracker_driver/protocol/ir_camera.h"

#include <wiimote_tracker_msgs/parameter_reader.h>

#include <cstdint>
#include <string>
#include <vector>

namespace wiimote_tracker::driver {

/// The parameters with their defaults; config/driver.yaml describes them.
struct DriverParameters {
  transport::DeviceName device;
  std::string camera_name;  ///< Empty: the last part of the node's namespace.
  std::string camera_info_url;
  ImageStamper::Options stamper;
  std::string ir_sensitivity = "wii_5";
  std::string ir_sensitivity_block1;        ///< Of "custom" only, hexadecimal.
  std::string ir_sensitivity_block2;        ///< Of "custom" only, hexadecimal.
  int leds = -1;                            ///< Player LEDs 1..4 in bits 0..3; -1: by the name.
  double battery_low = 0.2;                 ///< [0..1]
  double rumble_max = 2.0;                  ///< [s]
  double linear_acceleration_stddev = 0.1;  ///< [m/s^2]
  std::string record;
  double replay_rate = 1.0;
  int realtime_priority = 20;
  wiimote::Options remote;  ///< Its LEDs and sensitivity are those above.
};

/// Allowed values of ir_sensitivity: the named settings, and custom.
std::vector<std::string> sensitivityNames();

/// Reads the parameters of the driver; `name_space` is the camera's.
/// @throws ParameterError for what can never work.
DriverParameters readDriverParameters(ParameterReader* reader, const std::string& name_space);
inline DriverParameters readDriverParameters(ParameterReader reader,
                                             const std::string& name_space) {
  return readDriverParameters(&reader, name_space);
}

/// The setting of that name, or of the blocks when it is custom.
/// @throws std::invalid_argument with one sentence when there is no such setting.
protocol::IrSensitivity sensitivity(const std::string& name,
                                    const std::string& block1,
                                    const std::string& block2);

/// Player LEDs 1..4 (bits 0..3) for the parameter `leds`. Below 0 they are those for the number at
/// the end of a camera's name: the numbers of the lit LEDs add up to it. 1..4 light one LED, 5 is
/// 1 + 4, 10 is all four, 11 is as 1, and 0 is as 10. A name without a number lights LED 1.
std::uint8_t leds(int leds, const std::string& camera_name);

}  // namespace wiimote_tracker::driver
