#pragma once

#include "driver_fixture.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker::driver {

inline const std::string kIdentity = "00:1f:32:00:00:07";

inline virtual_wiimote::Senses lights(const std::vector<virtual_wiimote::Light>& lights) {
  virtual_wiimote::Senses senses;
  senses.lights = lights;
  return senses;
}

inline std::string parameter(const std::string& name) {
  std::string value;
  EXPECT_TRUE(ros::NodeHandle("~").getParam(name, value)) << name;
  return value;
}

/// The latest diagnostics of the driver of this camera.
inline diagnostic_msgs::DiagnosticStatus driverStatus(
    const Recorder<diagnostic_msgs::DiagnosticArray>& diagnostics,
    const std::string& camera = "wiimote_1") {
  for (auto array = diagnostics.messages.rbegin(); array != diagnostics.messages.rend(); ++array) {
    for (const auto& status : array->status) {
      if (status.name == camera + "/driver: Wii Remote " + camera)
        return status;
    }
  }
  return diagnostic_msgs::DiagnosticStatus();
}

inline std::map<std::string, std::string> values(const diagnostic_msgs::DiagnosticStatus& status) {
  std::map<std::string, std::string> result;
  for (const auto& value : status.values)
    result[value.key] = value.value;
  return result;
}

}  // namespace wiimote_tracker::driver
