#include "driver.h"

#include <nodelet/nodelet.h>
#include <wiimote_tracker_msgs/run_node.h>
#include <pluginlib/class_list_macros.hpp>

namespace wiimote_tracker::driver {

/// Driver in a nodelet manager.
class DriverNodelet : public nodelet::Nodelet {
  void onInit() override { driver_.start(getNodeHandle(), getPrivateNodeHandle()); }

  OwnThread<Driver> driver_;
};

}  // namespace wiimote_tracker::driver

PLUGINLIB_EXPORT_CLASS(wiimote_tracker::driver::DriverNodelet, nodelet::Nodelet)
