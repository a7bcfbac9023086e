#ifndef WIIMOTE_TRACKER_BRINGUP_BENCHMARK_LATENCY_PROBE_H
#define WIIMOTE_TRACKER_BRINGUP_BENCHMARK_LATENCY_PROBE_H

#include <geometry_msgs/PointStamped.h>
#include <ros/ros.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>

#include <atomic>
#include <condition_variable>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace wiimote_tracker {

/// Measures the latency from the arrival of a camera's report to that of the resulting
/// PointStamped: in this process, and in a callback. In one nodelet manager the former is the time
/// of publication. Then measures the round trip of a message to LatencyEcho and back. Both are two
/// hops. Callbacks must come from one thread.
class LatencyProbe {
 public:
  /// Private parameters: file (YAML results), label of the LED (default led), seconds (of each
  /// measurement, default 10). @throws std::runtime_error if one is missing.
  LatencyProbe(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh);
  ~LatencyProbe();

 private:
  void onPoints(const wiimote_tracker_msgs::TrackedPointArrayConstPtr& points);
  void onPoint(const ros::MessageEvent<const geometry_msgs::PointStamped>& event);
  void onPong(const geometry_msgs::PointStampedConstPtr& pong);
  void run();
  bool wait(double seconds);
  std::string measurePoints();
  std::vector<double> measureRoundTrips();

  std::string file_;
  double seconds_;
  std::mutex mutex_;  // protects the members below
  struct Arrival {
    ros::Time in_process, in_callback;
  };
  std::map<ros::Time, Arrival> arrivals_;    // arrival of the point with this stamp
  std::map<ros::Time, ros::Time> reported_;  // latest arrival of the images for this stamp
  bool is_back_ = false;
  std::condition_variable change_;

  std::atomic<bool> ended_{false};
  ros::Publisher ping_;
  ros::Subscriber pong_, points_, point_;
  std::thread thread_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_BRINGUP_BENCHMARK_LATENCY_PROBE_H
