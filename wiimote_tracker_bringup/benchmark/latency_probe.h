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

/// Takes the time from the arrival of a camera's report to the arrival of the PointStamped that it
/// led to, and that of a message's way to LatencyEcho and back, one after the other. Both are two
/// hops. Callbacks may come from one thread only.
class LatencyProbe {
 public:
  /// Private parameters: file (where the results go, as YAML), label of the LED (default led),
  /// seconds (of each measurement, default 10). @throws std::runtime_error when one is missing.
  LatencyProbe(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh);
  ~LatencyProbe();

 private:
  void onPoints(const wiimote_tracker_msgs::TrackedPointArrayConstPtr& points);
  void onPoint(const geometry_msgs::PointStampedConstPtr& point);
  void onPong(const geometry_msgs::PointStampedConstPtr& pong);
  void run();
  bool wait(double seconds);
  std::vector<double> measurePoints();
  std::vector<double> measureRoundTrips();

  std::string file_;
  double seconds_;
  std::mutex mutex_;                         // of what follows
  std::map<ros::Time, ros::Time> came_;      // when a point of this stamp came
  std::map<ros::Time, ros::Time> reported_;  // latest arrival of the images of this stamp
  bool is_back_ = false;
  std::condition_variable change_;

  std::atomic<bool> ended_{false};
  ros::Publisher ping_;
  ros::Subscriber pong_, points_, point_;
  std::thread thread_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_BRINGUP_BENCHMARK_LATENCY_PROBE_H
