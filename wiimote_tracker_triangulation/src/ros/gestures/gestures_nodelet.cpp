#include "gestures.h"

#include <nodelet/nodelet.h>
#include <wiimote_tracker_msgs/run_node.h>
#include <pluginlib/class_list_macros.hpp>

#include <exception>
#include <memory>

namespace wiimote_tracker {

class GesturesNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      // These handles call back from one thread at a time.
      gestures_ = std::make_unique<Gestures>(getNodeHandle(), getPrivateNodeHandle());
    } catch (const ParameterError& e) {
      if (!staysRefused(e))
        throw;  // the manager reports that it could not load
    } catch (const std::exception& e) {
      NODELET_FATAL("%s", e.what());
      throw;
    }
  }

  std::unique_ptr<Gestures> gestures_;
};

}  // namespace wiimote_tracker

PLUGINLIB_EXPORT_CLASS(wiimote_tracker::GesturesNodelet, nodelet::Nodelet)
