#pragma once

#include "wiimote_tracker_msgs/log_exceptions.h"
#include "wiimote_tracker_msgs/parameter_reader.h"
#include "wiimote_tracker_msgs/refusal_report.h"

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <thread>

namespace wiimote_tracker {

/// Handles callbacks until the node ends, as ros::spin() does, but logs what they throw. Ours catch
/// their exceptions; those of libraries, such as actionlib's, do not.
/// @param threads that handle callbacks at the same time.
void spin(std::size_t threads = 1);

/// What a node does with its public and private handles; it returns when the node is to end.
using NodeFunction = std::function<void(const ros::NodeHandle&, const ros::NodeHandle&)>;

/// A node's main(): calls `node`. Without a master, or when an exception comes, it says so in one
/// sentence; after a refused parameter it waits for its end if it is respawned.
/// @param purpose for --help, with its line breaks; says where the parameters stand.
/// @returns the exit status.
int runNode(int argc,
            char** argv,
            const std::string& name,
            const std::string& purpose,
            const NodeFunction& node);

/// The same for an object that is made of both handles and needs one thread for its callbacks.
template <typename Object>
int runNode(int argc, char** argv, const std::string& name, const std::string& purpose) {
  return runNode(argc, argv, name, purpose,
                 [](const ros::NodeHandle& nh, const ros::NodeHandle& private_nh) {
                   const Object object(nh, private_nh);
                   spin();
                 });
}

/// A nodelet's object with a callback queue and a thread of its own. The manager's queues pass each
/// message through two threads, and in some versions of nodelet they drop what comes while the
/// nodelet is loaded: a latched message would be handled only when the next one comes, and so each
/// message after it.
template <typename Object>
class OwnThread {
 public:
  OwnThread() = default;
  OwnThread(const OwnThread&) = delete;
  OwnThread& operator=(const OwnThread&) = delete;

  /// Makes the object of both handles, then handles its callbacks. After a refused parameter it may
  /// only report that (see staysRefused()).
  /// @throws what the object throws: the manager reports that it could not load.
  void start(ros::NodeHandle nh, ros::NodeHandle private_nh) {
    nh.setCallbackQueue(&queue_);
    private_nh.setCallbackQueue(&queue_);
    try {
      object_ = std::make_unique<Object>(nh, private_nh);
    } catch (const ParameterError& e) {
      if (!staysRefused(e))
        throw;
      report_ = std::make_unique<RefusalReport>(nh, private_nh.getNamespace(), e);
    } catch (const std::exception& e) {
      ROS_FATAL("%s", e.what());
      throw;
    }
    thread_ = std::thread([this] { handle(); });
  }

  /// The thread ends first, then what its callbacks use.
  ~OwnThread() {
    is_ending_ = true;
    queue_.disable();  // ends the wait
    if (thread_.joinable())
      thread_.join();
  }

 private:
  void handle() {
    while (!is_ending_)
      logExceptions(ros::this_node::getName(),
                    [this] { queue_.callOne(ros::WallDuration(1.0)); });  // as in spin()
  }

  ros::CallbackQueue queue_;
  std::unique_ptr<Object> object_;
  std::unique_ptr<RefusalReport> report_;
  std::atomic<bool> is_ending_{false};
  std::thread thread_;
};

}  // namespace wiimote_tracker
