#include "battery_publisher.h"

#include <ros/console.h>
#include <sensor_msgs/BatteryState.h>
#include <wiimote_tracker_msgs/text.h>

#include <limits>

namespace wiimote_tracker::driver {
namespace {

// An increase above the threshold by this much means new batteries.
constexpr double kNewBatteries = 0.1;
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

}  // namespace

bool batteryLow(const protocol::Status& status, double threshold) {
  return status.battery_low || protocol::batteryCharge(status.battery) < threshold;
}

std::string batteryText(const protocol::Status& status, double threshold) {
  const double charge = protocol::batteryCharge(status.battery);
  return charge < threshold ? format("%.0f %%", 100.0 * charge)
                            : format("the remote says so, at the raw level %d", status.battery);
}

BatteryPublisher::BatteryPublisher(ros::NodeHandle& nh, const std::string& camera, double threshold)
    : camera_(camera),
      threshold_(threshold),
      publisher_(nh.advertise<sensor_msgs::BatteryState>("battery", 1, true)) {}

void BatteryPublisher::publish(const protocol::Status& status,
                               const std::string& identity,
                               const ros::Time& stamp) {
  const double charge = protocol::batteryCharge(status.battery);
  sensor_msgs::BatteryState message;
  message.header.stamp = stamp;
  message.voltage = kUnknown;
  message.temperature = kUnknown;
  message.current = kUnknown;
  message.charge = kUnknown;
  message.capacity = kUnknown;
  message.design_capacity = kUnknown;
  message.percentage = static_cast<float>(charge);
  // The remote does not know whether batteries or a power supply feed it.
  message.power_supply_status = sensor_msgs::BatteryState::POWER_SUPPLY_STATUS_UNKNOWN;
  message.power_supply_health = sensor_msgs::BatteryState::POWER_SUPPLY_HEALTH_UNKNOWN;
  message.power_supply_technology = sensor_msgs::BatteryState::POWER_SUPPLY_TECHNOLOGY_UNKNOWN;
  message.present = true;
  message.location = camera_;
  message.serial_number = identity;
  publisher_.publish(message);

  const bool low = batteryLow(status, threshold_);
  if (low && !warned_) {
    warned_ = true;
    ROS_WARN("%s: the batteries are nearly empty (%s): change them soon", camera_.c_str(),
             batteryText(status, threshold_).c_str());
  } else if (!low && charge > threshold_ + kNewBatteries) {
    warned_ = false;
  }
}

}  // namespace wiimote_tracker::driver
