#pragma once

#include "wiimote_tracker_driver/protocol/input_reports.h"

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <string>

namespace wiimote_tracker::driver {

/// Whether the remote reports low batteries, or their charge is below `threshold` [0..1].
bool batteryLow(const protocol::Status& status, double threshold);

/// Why the batteries are low: their charge, or that only the remote says so.
std::string batteryText(const protocol::Status& status, double threshold);

/// Publishes the charge, latched, as `battery`, and warns once when it is low.
class BatteryPublisher {
 public:
  /// `threshold`: charge below which it is low [0..1].
  BatteryPublisher(ros::NodeHandle& nh, const std::string& camera, double threshold);

  /// Publishes a status that came at `stamp`.
  void publish(const protocol::Status& status, const std::string& identity, const ros::Time& stamp);

 private:
  const std::string camera_;
  const double threshold_;
  ros::Publisher publisher_;
  bool warned_ = false;
};

}  // namespace wiimote_tracker::driver
