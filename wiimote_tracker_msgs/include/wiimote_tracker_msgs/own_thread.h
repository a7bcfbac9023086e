#ifndef WIIMOTE_TRACKER_MSGS_OWN_THREAD_H
#define WIIMOTE_TRACKER_MSGS_OWN_THREAD_H

#include "wiimote_tracker_msgs/run_node.h"

#include <ros/callback_queue.h>
#include <ros/spinner.h>

#include <exception>
#include <memory>

namespace wiimote_tracker {

/// A nodelet's object with a callback queue and a thread of its own. The manager's queues pass each
/// message through two threads, and in some versions of nodelet they drop what comes while the
/// nodelet is loaded: a latched message would be handled only when the next one comes, and so each
/// message after it.
template <typename Object>
class OwnThread {
 public:
  /// Makes the object of both handles, then handles its callbacks. After a refused parameter it may
  /// do nothing (see staysRefused()).
  /// @throws what the object throws: the manager reports that it could not load.
  void start(ros::NodeHandle nh, ros::NodeHandle private_nh) {
    nh.setCallbackQueue(&queue_);
    private_nh.setCallbackQueue(&queue_);
    try {
      object_ = std::make_unique<Object>(nh, private_nh);
    } catch (const ParameterError& e) {
      if (staysRefused(e))
        return;
      throw;
    } catch (const std::exception& e) {
      ROS_FATAL("%s", e.what());
      throw;
    }
    thread_.start();
  }

 private:
  // The thread ends first, then what its callbacks use.
  ros::CallbackQueue queue_;
  std::unique_ptr<Object> object_;
  ros::AsyncSpinner thread_{1, &queue_};
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_MSGS_OWN_THREAD_H
