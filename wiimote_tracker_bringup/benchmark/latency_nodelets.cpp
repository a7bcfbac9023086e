#include "latency_probe.h"

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include <memory>

namespace wiimote_tracker {

class LatencyProbeNodelet : public nodelet::Nodelet {
  void onInit() override {
    try {
      probe_ = std::make_unique<LatencyProbe>(getNodeHandle(), getPrivateNodeHandle());
    } catch (const std::exception& e) {
      NODELET_FATAL("%s", e.what());
      throw;
    }
  }

  std::unique_ptr<LatencyProbe> probe_;
};

/// Returns every message unchanged.
class LatencyEchoNodelet : public nodelet::Nodelet {
  void onInit() override {
    pong_ = getNodeHandle().advertise<geometry_msgs::PointStamped>("latency/pong", 10);
    ping_ = getNodeHandle().subscribe<geometry_msgs::PointStamped>(
        "latency/ping", 10,
        [this](const geometry_msgs::PointStampedConstPtr& ping) { pong_.publish(ping); },
        ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  }

  ros::Publisher pong_;
  ros::Subscriber ping_;
};

}  // namespace wiimote_tracker

PLUGINLIB_EXPORT_CLASS(wiimote_tracker::LatencyProbeNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(wiimote_tracker::LatencyEchoNodelet, nodelet::Nodelet)
