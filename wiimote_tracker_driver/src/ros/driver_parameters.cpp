#include "driver_parameters.h"

#include "wiimote_tracker_driver/protocol/ir_camera.h"
#include "wiimote_tracker_driver/transport/transport.h"

#include <wiimote_tracker_msgs/parameter_reader.h>

#include <cctype>

namespace wiimote_tracker::driver {
namespace {

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

}  // namespace

DriverParameters readDriverParameters(const ros::NodeHandle& nh,
                                      const ros::NodeHandle& private_nh) {
  ParameterReader reader(private_nh);
  DriverParameters p;
  p.device = reader.optional("device", p.device);
  p.camera_name = reader.optional("camera_name", p.camera_name);
  p.camera_info_url = reader.optional("camera_info_url", p.camera_info_url);
  p.latency = reader.bounded("latency", p.latency, 0.0, 1.0);
  p.ir_sensitivity =
      reader.choice("ir_sensitivity", p.ir_sensitivity, protocol::irSensitivityNames());
  p.leds = reader.bounded("leds", p.leds, 0, 15);
  p.linear_acceleration_stddev =
      reader.bounded("linear_acceleration_stddev", p.linear_acceleration_stddev, 1e-6, 100.0);
  p.reply_timeout = reader.bounded("reply_timeout", p.reply_timeout, 0.05, 10.0);
  p.silence_timeout = reader.bounded("silence_timeout", p.silence_timeout, 0.1, 60.0);
  p.status_interval = reader.bounded("status_interval", p.status_interval, 1.0, 86400.0);
  reader.allow("diagnostic_period");  // diagnostic_updater's own
  reader.refuseUnknown();

  try {
    transport::parseDeviceName(p.device);
  } catch (const transport::BadDeviceName& e) {
    throw ParameterError(private_nh.resolveName("device") + ": " + e.what());
  }
  if (p.camera_name.empty())
    p.camera_name = lastPart(nh.getNamespace());
  if (!isCameraName(p.camera_name))
    throw ParameterError(private_nh.resolveName("camera_name") + " is '" + p.camera_name +
                         "', but must consist of letters, digits and underscores");
  return p;
}

}  // namespace wiimote_tracker::driver
