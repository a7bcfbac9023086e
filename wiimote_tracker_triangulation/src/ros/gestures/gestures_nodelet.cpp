#include "gestures.h"

#include <nodelet/nodelet.h>
#include <wiimote_tracker_msgs/run_node.h>
#include <pluginlib/class_list_macros.hpp>

namespace wiimote_tracker {

/// Gestures in a nodelet manager.
class GesturesNodelet : public nodelet::Nodelet {
  void onInit() override { gestures_.start(getNodeHandle(), getPrivateNodeHandle()); }

  OwnThread<Gestures> gestures_;
};

}  // namespace wiimote_tracker

PLUGINLIB_EXPORT_CLASS(wiimote_tracker::GesturesNodelet, nodelet::Nodelet)
