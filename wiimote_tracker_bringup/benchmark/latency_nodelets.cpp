// For benchmark_latency: nodelets that take the time, and that send a message back.

#include <geometry_msgs/PointStamped.h>
#include <nodelet/nodelet.h>
#include <ros/ros.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>
#include <boost/make_shared.hpp>
#include <pluginlib/class_list_macros.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <fstream>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace wiimote_tracker {
namespace {

constexpr std::size_t kWarmUp = 1000;   // points before the measurement
constexpr double kPingPeriod = 0.0025;  // [s]; the mean interval of four cameras' images
constexpr double kPongTimeout = 1.0;    // [s]

/// Quantiles of latencies in seconds, as a line of YAML in milliseconds.
std::string summary(const std::string& name, std::vector<double> seconds) {
  if (seconds.empty())
    return name + ": {count: 0}\n";
  std::sort(seconds.begin(), seconds.end());
  const auto at = [&](double share) {
    return std::to_string(
        1e3 * seconds[static_cast<std::size_t>(share * static_cast<double>(seconds.size() - 1))]);
  };
  return name + ": {count: " + std::to_string(seconds.size()) + ", p50: " + at(0.5) +
         ", p95: " + at(0.95) + ", p99: " + at(0.99) + ", max: " + at(1.0) + "}\n";
}

}  // namespace

/// Measures the latency from the arrival of a camera's report to that of the resulting points: in
/// this process, and in a callback. In one nodelet manager the former is the time of publication.
/// Then measures the round trip of a message to LatencyEcho and back. Both are two hops.
class LatencyProbe : public nodelet::Nodelet {
 public:
  ~LatencyProbe() override;

 private:
  /// Private parameters: file (YAML results), seconds (of each measurement, default 10).
  /// @throws std::runtime_error if one is missing.
  void onInit() override;

  using PointsEvent = ros::MessageEvent<const wiimote_tracker_msgs::TrackedPointArray>;
  void onPoints(const PointsEvent& event);
  void onPong(const geometry_msgs::PointStampedConstPtr& pong);
  void run();
  bool wait(double seconds);
  std::string measurePoints();
  std::vector<double> measureRoundTrips();

  std::string file_;
  double seconds_ = 0.0;
  std::mutex mutex_;                              // protects the members below
  std::vector<double> in_process_, in_callback_;  // latencies of points [s]
  bool is_back_ = false;
  std::condition_variable change_;

  std::atomic<bool> ended_{false};
  ros::Publisher ping_;
  ros::Subscriber pong_, points_;
  std::thread thread_;
};

void LatencyProbe::onInit() {
  ros::NodeHandle& nh = getNodeHandle();
  const ros::NodeHandle& private_nh = getPrivateNodeHandle();
  file_ = private_nh.param<std::string>("file", "");
  seconds_ = private_nh.param("seconds", 10.0);
  if (file_.empty()) {
    const std::string refusal =
        "set " + private_nh.resolveName("file") + " to the file for the results";
    NODELET_FATAL("%s", refusal.c_str());
    throw std::runtime_error(refusal);
  }
  const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
  ping_ = nh.advertise<geometry_msgs::PointStamped>("latency/ping", 10);
  pong_ = nh.subscribe("latency/pong", 10, &LatencyProbe::onPong, this, no_delay);
  points_ = nh.subscribe<wiimote_tracker_msgs::TrackedPointArray, const PointsEvent&>(
      "points", 1000, [this](const PointsEvent& event) { onPoints(event); }, ros::VoidConstPtr(),
      no_delay);
  thread_ = std::thread([this] { run(); });
}

LatencyProbe::~LatencyProbe() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);  // wait() must not miss it
    ended_ = true;
  }
  change_.notify_all();
  if (thread_.joinable())
    thread_.join();
}

void LatencyProbe::onPoints(const PointsEvent& event) {
  const ros::Time now = ros::Time::now();
  const wiimote_tracker_msgs::TrackedPointArray& points = *event.getConstMessage();
  if (points.points.empty())
    return;
  const std::lock_guard<std::mutex> lock(mutex_);
  in_process_.push_back((event.getReceiptTime() - points.latest_arrival).toSec());
  in_callback_.push_back((now - points.latest_arrival).toSec());
}

void LatencyProbe::onPong(const geometry_msgs::PointStampedConstPtr&) {
  const std::lock_guard<std::mutex> lock(mutex_);
  is_back_ = true;
  change_.notify_all();
}

/// @returns whether to go on.
bool LatencyProbe::wait(double seconds) {
  std::unique_lock<std::mutex> lock(mutex_);
  change_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return ended_.load(); });
  return !ended_;
}

void LatencyProbe::run() {
  const auto count = [this] {
    const std::lock_guard<std::mutex> lock(mutex_);
    return in_process_.size();
  };
  while (count() < kWarmUp || ping_.getNumSubscribers() == 0 || pong_.getNumPublishers() == 0) {
    if (!wait(0.1))
      return;
  }
  const std::string points = measurePoints();
  const std::string round_trips = summary("round_trips", measureRoundTrips());
  if (ended_)
    return;
  std::ofstream(file_ + ".part") << points << round_trips;
  std::rename((file_ + ".part").c_str(), file_.c_str());  // atomic
}

std::string LatencyProbe::measurePoints() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    in_process_.clear();
    in_callback_.clear();
  }
  if (!wait(seconds_))
    return "";
  const std::lock_guard<std::mutex> lock(mutex_);
  return summary("in_process", in_process_) + summary("points", in_callback_);
}

std::vector<double> LatencyProbe::measureRoundTrips() {
  using Clock = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<double>;
  std::vector<double> latencies;
  const Clock::time_point end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(Seconds(seconds_));
  for (auto due = Clock::now(); due < end && !ended_;
       due += std::chrono::duration_cast<Clock::duration>(Seconds(kPingPeriod))) {
    std::this_thread::sleep_until(due);
    std::unique_lock<std::mutex> lock(mutex_);
    is_back_ = false;
    lock.unlock();
    const auto ping = boost::make_shared<geometry_msgs::PointStamped>();
    const Clock::time_point begin = Clock::now();
    ping_.publish(ping);
    lock.lock();
    if (change_.wait_for(lock, Seconds(kPongTimeout), [this] { return is_back_; }))
      latencies.push_back(Seconds(Clock::now() - begin).count());
  }
  return latencies;
}

/// Returns every message unchanged.
class LatencyEcho : public nodelet::Nodelet {
  void onInit() override {
    pong_ = getNodeHandle().advertise<geometry_msgs::PointStamped>("latency/pong", 10);
    ping_ = getNodeHandle().subscribe<geometry_msgs::PointStamped>(
        "latency/ping", 10,
        [this](const geometry_msgs::PointStampedConstPtr& ping) { pong_.publish(ping); },
        ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  }

  ros::Publisher pong_;
  ros::Subscriber ping_;
};

}  // namespace wiimote_tracker

PLUGINLIB_EXPORT_CLASS(wiimote_tracker::LatencyProbe, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(wiimote_tracker::LatencyEcho, nodelet::Nodelet)
