#include "triangulation.h"

#include <nodelet/nodelet.h>
#include <wiimote_tracker_msgs/run_node.h>
#include <pluginlib/class_list_macros.hpp>

namespace wiimote_tracker {

/// Triangulation in a nodelet manager.
class TriangulationNodelet : public nodelet::Nodelet {
  void onInit() override { triangulation_.start(getNodeHandle(), getPrivateNodeHandle()); }

  OwnThread<Triangulation> triangulation_;
};

}  // namespace wiimote_tracker

PLUGINLIB_EXPORT_CLASS(wiimote_tracker::TriangulationNodelet, nodelet::Nodelet)
