#include "triangulation.h"

#include <nodelet/nodelet.h>
#include <ros/callback_queue.h>
#include <wiimote_tracker_msgs/parameter_reader.h>
#include <pluginlib/class_list_macros.hpp>

#include <atomic>
#include <memory>
#include <thread>

namespace wiimote_tracker {

/// With a thread of its own that handles images: the manager would wake one of its threads to take
/// each out of a queue, and another one to handle it.
class TriangulationNodelet : public nodelet::Nodelet {
 public:
  ~TriangulationNodelet() override {
    is_over_ = true;
    if (thread_.joinable())
      thread_.join();
  }

 private:
  void onInit() override {
    ros::NodeHandle nh = getNodeHandle();
    ros::NodeHandle private_nh = getPrivateNodeHandle();
    nh.setCallbackQueue(&queue_);
    private_nh.setCallbackQueue(&queue_);
    try {
      triangulation_ = std::make_unique<Triangulation>(nh, private_nh);
    } catch (const ParameterError& e) {
      NODELET_FATAL("%s", e.what());
      throw;  // the manager reports that it could not load
    }
    thread_ = std::thread([this] {
      const ros::WallDuration until_looking_whether_it_is_over(0.1);
      while (!is_over_)
        queue_.callAvailable(until_looking_whether_it_is_over);
    });
  }

  ros::CallbackQueue queue_;
  std::unique_ptr<Triangulation> triangulation_;
  std::atomic<bool> is_over_{false};
  std::thread thread_;
};

}  // namespace wiimote_tracker

PLUGINLIB_EXPORT_CLASS(wiimote_tracker::TriangulationNodelet, nodelet::Nodelet)
