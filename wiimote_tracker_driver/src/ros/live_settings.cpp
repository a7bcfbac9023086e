#include "live_settings.h"

#include <ros/console.h>
#include <wiimote_tracker_msgs/log_exceptions.h>

#include <stdexcept>

namespace wiimote_tracker::driver {

LiveSettings::LiveSettings(const ros::NodeHandle& private_nh,
                           const DriverParameters& parameters,
                           RemoteControl& control)
    : camera_name_(parameters.camera_name), control_(control), server_(private_nh) {
  used_.ir_sensitivity = parameters.ir_sensitivity;
  used_.ir_sensitivity_block1 = parameters.ir_sensitivity_block1;
  used_.ir_sensitivity_block2 = parameters.ir_sensitivity_block2;
  used_.leds = parameters.leds;
  server_.setCallback([this](Config& config, std::uint32_t) {
    logExceptions(camera_name_, [&] { reconfigure(config); });
  });
}

std::string LiveSettings::sensitivity() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (used_.ir_sensitivity != "custom")
    return used_.ir_sensitivity;
  return "custom: " + used_.ir_sensitivity_block1 + " / " + used_.ir_sensitivity_block2;
}

void LiveSettings::reconfigure(Config& config) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto setting = [](const Config& c) {
    return driver::sensitivity(c.ir_sensitivity, c.ir_sensitivity_block1, c.ir_sensitivity_block2);
  };
  try {
    if (!(setting(config) == setting(used_)))
      control_.setSensitivity(setting(config));
  } catch (const std::invalid_argument& e) {
    ROS_WARN("%s: the sensitivity is unchanged: %s", camera_name_.c_str(), e.what());
    config.ir_sensitivity = used_.ir_sensitivity;
    config.ir_sensitivity_block1 = used_.ir_sensitivity_block1;
    config.ir_sensitivity_block2 = used_.ir_sensitivity_block2;
  }
  if (config.leds != used_.leds)
    control_.setLeds(leds(config.leds, camera_name_));
  used_ = config;
}

}  // namespace wiimote_tracker::driver
