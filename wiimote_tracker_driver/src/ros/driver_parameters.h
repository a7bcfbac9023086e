#ifndef WIIMOTE_TRACKER_DRIVER_ROS_DRIVER_PARAMETERS_H
#define WIIMOTE_TRACKER_DRIVER_ROS_DRIVER_PARAMETERS_H

#include "wiimote_tracker_driver/protocol/input_reports.h"
#include "wiimote_tracker_driver/protocol/ir_camera.h"

#include <ros/node_handle.h>

#include <cstdint>
#include <string>
#include <vector>

namespace wiimote_tracker::driver {

/// What can be set; config/driver.yaml says what each means.
struct DriverParameters {
  std::string device;
  std::string camera_name;  ///< Empty: the last part of the node's namespace.
  std::string camera_info_url;
  double latency = 0.0;  ///< [s]
  bool estimate_exposure = true;
  std::string ir_mode = "extended";
  std::string ir_sensitivity = "wii_5";
  std::string ir_sensitivity_block1;  ///< Of "custom" only, hexadecimal.
  std::string ir_sensitivity_block2;  ///< Of "custom" only, hexadecimal.
  int leds = -1;                      ///< Player LEDs 1..4 in bits 0..3; -1: as the name says.
  double battery_low = 0.2;           ///< [0..1]
  double rumble_max = 2.0;            ///< [s]
  double linear_acceleration_stddev = 0.1;  ///< [m/s^2]
  std::string record;
  double replay_rate = 1.0;
  int realtime_priority = 20;
  double reply_timeout = 0.5;     ///< [s]
  double silence_timeout = 0.5;   ///< [s]
  double status_interval = 60.0;  ///< [s]
};

/// Reads the parameters of the private namespace; `nh` is the camera's namespace.
/// @throws ParameterError for what can never work.
DriverParameters readDriverParameters(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh);

/// What ir_mode may be: basic, extended, full.
protocol::IrFormat irFormat(const std::string& ir_mode);

/// What ir_sensitivity may be: the settings known by name, and custom.
std::vector<std::string> sensitivityNames();

/// The setting of that name, or of the blocks when it is custom.
/// @throws std::invalid_argument with one sentence when there is no such setting.
protocol::IrSensitivity sensitivity(const std::string& name,
                                    const std::string& block1,
                                    const std::string& block2);

/// Player LEDs 1..4 in bits 0..3. `leds`: as the parameter.
std::uint8_t leds(int leds, const std::string& camera_name);

}  // namespace wiimote_tracker::driver

#endif  // WIIMOTE_TRACKER_DRIVER_ROS_DRIVER_PARAMETERS_H
