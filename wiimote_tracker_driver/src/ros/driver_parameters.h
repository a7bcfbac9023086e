#ifndef WIIMOTE_TRACKER_DRIVER_ROS_DRIVER_PARAMETERS_H
#define WIIMOTE_TRACKER_DRIVER_ROS_DRIVER_PARAMETERS_H

#include <ros/node_handle.h>

#include <string>

namespace wiimote_tracker::driver {

/// What can be set; config/driver.yaml says what each means.
struct DriverParameters {
  std::string device;
  std::string camera_name;  ///< Empty: the last part of the node's namespace.
  std::string camera_info_url;
  double latency = 0.0;  ///< [s]
  std::string ir_sensitivity = "wii_5";
  int leds = 1;                             ///< Player LEDs 1..4 in bits 0..3.
  double linear_acceleration_stddev = 0.1;  ///< [m/s^2]
  double reply_timeout = 0.5;               ///< [s]
  double silence_timeout = 0.5;             ///< [s]
  double status_interval = 60.0;            ///< [s]
};

/// Reads the parameters of the private namespace; `nh` is the camera's namespace.
/// @throws ParameterError for what can never work.
DriverParameters readDriverParameters(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh);

}  // namespace wiimote_tracker::driver

#endif  // WIIMOTE_TRACKER_DRIVER_ROS_DRIVER_PARAMETERS_H
