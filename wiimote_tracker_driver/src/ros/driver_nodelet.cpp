#include "driver.h"

#include <nodelet/nodelet.h>
#include <wiimote_tracker_msgs/run_node.h>
#include <pluginlib/class_list_macros.hpp>

#include <memory>

namespace wiimote_tracker::driver {

/// Driver in a nodelet manager.
class DriverNodelet : public nodelet::Nodelet {
  void onInit() override {
    try {
      driver_ = std::make_unique<Driver>(getNodeHandle(), getPrivateNodeHandle());
    } catch (const ParameterError& e) {
      if (!staysRefused(e))
        throw;
    } catch (const std::exception& e) {
      NODELET_FATAL("%s", e.what());
      throw;
    }
  }

  std::unique_ptr<Driver> driver_;
};

}  // namespace wiimote_tracker::driver

PLUGINLIB_EXPORT_CLASS(wiimote_tracker::driver::DriverNodelet, nodelet::Nodelet)
