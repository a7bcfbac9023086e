#pragma once

#include "description.h"
#include "rig.h"

#include "wiimote_tracker_driver/virtual_wiimote/server.h"

#include <ros/ros.h>
#include <wiimote_tracker_msgs/SetLed.h>

#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace wiimote_tracker::simulation {

/// A Rig in real time: cameras are virtual Wii Remotes at <socket_directory>/<camera>.sock; service
/// simulation/set_led; truth on simulation/truth/<led> and <body>, and simulation/exposures.
class SimulatedRig {
 public:
  /// @throws std::system_error if a socket cannot be created.
  SimulatedRig(ros::NodeHandle nh,
               const Description& description,
               const std::string& socket_directory);

  /// Runs until ROS shuts down.
  void run();

 private:
  bool setLed(wiimote_tracker_msgs::SetLed::Request& request,
              wiimote_tracker_msgs::SetLed::Response& response);
  std::string set(const wiimote_tracker_msgs::SetLed::Request& request, double* time);
  std::string setBoard(const wiimote_tracker_msgs::SetLed::Request& request);
  std::string setReflection(const wiimote_tracker_msgs::SetLed::Request& request,
                            ReflectionDescription* reflection) const;
  std::string turnCamera(const wiimote_tracker_msgs::SetLed::Request& request,
                         VirtualCamera* camera) const;
  double move(const wiimote_tracker_msgs::SetLed::Request& request,
              double time,
              LedMotion* motion) const;
  void check(const wiimote_tracker_msgs::SetLed::Request& request) const;
  double now() const;                  ///< [s since the start]
  ros::Time stamp(double time) const;  ///< Of a time since the start.
  void deliver(std::size_t camera, const Image& image);
  bool isLost(const Image& image);
  void publishTruth(std::size_t led, double time, const Eigen::Vector3d& position);
  void publishBodyTruth(std::size_t body, double time, const Eigen::Isometry3d& pose);

  std::string world_frame_;
  std::map<std::string, Drawing> drawings_;
  std::chrono::steady_clock::time_point start_;
  ros::Time start_stamp_;
  std::vector<std::unique_ptr<virtual_wiimote::Server>> servers_;
  std::vector<std::string> cameras_;
  ros::Publisher exposures_;
  std::vector<ros::Publisher> truth_;
  std::vector<ros::Publisher> body_truth_;
  std::mutex mutex_;  ///< Guards rig_ and is_late_.
  Rig rig_;
  bool is_late_ = false;
  ros::ServiceServer set_led_;
};

}  // namespace wiimote_tracker::simulation
