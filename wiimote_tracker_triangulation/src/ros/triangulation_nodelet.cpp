#include "triangulation.h"

#include <nodelet/nodelet.h>
#include <ros/callback_queue.h>
#include <ros/spinner.h>
#include <wiimote_tracker_msgs/run_node.h>
#include <pluginlib/class_list_macros.hpp>

#include <memory>

namespace wiimote_tracker {

/// Has its own callback queue and thread: the manager's queues pass each message through two
/// threads.
class TriangulationNodelet : public nodelet::Nodelet {
  void onInit() override {
    ros::NodeHandle nh = getNodeHandle();
    ros::NodeHandle private_nh = getPrivateNodeHandle();
    nh.setCallbackQueue(&queue_);
    private_nh.setCallbackQueue(&queue_);
    try {
      triangulation_ = std::make_unique<Triangulation>(nh, private_nh);
    } catch (const ParameterError& e) {
      if (staysRefused(e))
        return;
      throw;  // the manager reports that it could not load
    }
    thread_.start();
  }

  // The thread ends first, then what its callbacks use.
  ros::CallbackQueue queue_;
  std::unique_ptr<Triangulation> triangulation_;
  ros::AsyncSpinner thread_{1, &queue_};
};

}  // namespace wiimote_tracker

PLUGINLIB_EXPORT_CLASS(wiimote_tracker::TriangulationNodelet, nodelet::Nodelet)
