#include "trials.h"

#include "own_master.h"
#include "temporary_folder.h"
#include "virtual_remotes.h"

#include <nodelet/loader.h>
#include <ros/ros.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <deque>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace wiimote_tracker {
namespace {

constexpr double kStartLimit = 60.0;  // [s]
// Each remote has streamed this many images before the measurement begins.
constexpr std::uint32_t kWarmUp = 300;
// Reports sent within this time before the end may still be in transit [s].
constexpr double kUnderWay = 0.5;

void wait(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

/// Arrival time of each sample of a remote [s]; 0: none. Written by one thread.
class Arrivals {
 public:
  Arrivals() : arrivals_(VirtualRemotes::kMostSamples, 0.0) {}

  void add(const wiimote_tracker_msgs::IrBlobArray& message) {
    const double now = steadyNow();
    if (message.blobs.size() != 1)
      return;
    const auto& blob = message.blobs[0];
    const int y = static_cast<int>(message.height) - 1 - static_cast<int>(blob.y);
    const std::uint32_t sample = VirtualRemotes::sampleAt(static_cast<int>(blob.x), y);
    if (sample >= arrivals_.size() || arrivals_[sample] > 0.0)
      return;  // a report is repeated when the mode is set again
    arrivals_[sample] = now;
    ++received_;
  }

  double at(std::uint32_t sample) const { return arrivals_[sample]; }
  std::uint32_t received() const { return received_; }

 private:
  std::vector<double> arrivals_;
  std::atomic<std::uint32_t> received_{0};
};

/// Of this process [s].
double processorTime() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

std::string nameOf(int remote) {
  return "/wiimote_" + std::to_string(remote + 1);
}

void load(nodelet::Loader& loader, const VirtualRemotes& remotes, const std::string& folder) {
  for (int i = 0; i < remotes.count(); ++i) {
    const std::string name = nameOf(i) + "/driver";
    ros::param::set(name + "/device", "virtual:" + remotes.socket(i));
    ros::param::set(name + "/camera_info_url",
                    "file://" + folder + "/" + std::to_string(i) + ".yaml");
    if (!loader.load(name, "wiimote_tracker_driver/Driver", ros::names::getRemappings(), {}))
      throw std::runtime_error(
          "the nodelet wiimote_tracker_driver/Driver cannot be loaded: build "
          "the package and source its setup.bash");
  }
}

/// Of sorted values.
double quantile(const std::vector<double>& values, double q) {
  return values.at(static_cast<std::size_t>(q * static_cast<double>(values.size() - 1)));
}

Results evaluate(const VirtualRemotes& remotes,
                 const std::deque<Arrivals>& arrivals,
                 double from,
                 double to,
                 double processor_time) {
  std::vector<double> latencies;
  double sent = 0.0;
  for (int i = 0; i < remotes.count(); ++i) {
    for (std::uint32_t sample = 0; sample < VirtualRemotes::kMostSamples; ++sample) {
      const double sent_at = remotes.sentAt(i, sample);
      if (sent_at < from || sent_at > to)
        continue;
      ++sent;
      const double arrival = arrivals[static_cast<std::size_t>(i)].at(sample);
      if (arrival > 0.0)
        latencies.push_back(arrival - sent_at);
    }
  }
  if (latencies.empty())
    throw std::runtime_error(
        "no image came while it was measured: stop what keeps this computer busy");
  std::sort(latencies.begin(), latencies.end());
  const double count = remotes.count();
  const double duration = to - from;
  const auto received = static_cast<double>(latencies.size());
  return {{"remotes", count, "1"},
          {"duration", duration, "s"},
          {"rate_per_remote", sent / duration / count, "Hz"},
          {"processor_per_remote", 100.0 * processor_time / count, "% of a core"},
          {"latency_p50", 1e3 * quantile(latencies, 0.5), "ms"},
          {"latency_p99", 1e3 * quantile(latencies, 0.99), "ms"},
          {"latency_max", 1e3 * latencies.back(), "ms"},
          {"reports", sent, "1"},
          {"dropped", sent - received, "1"}};
}

}  // namespace

Results runLoad(int count, double duration) {
  const TemporaryFolder folder;
  const VirtualRemotes remotes(count, folder.path());
  OwnMaster master;
  master.connect();

  ros::NodeHandle nh;
  std::deque<Arrivals> arrivals;
  std::vector<ros::Subscriber> subscribers;
  for (int i = 0; i < count; ++i) {
    arrivals.emplace_back();
    subscribers.push_back(nh.subscribe<wiimote_tracker_msgs::IrBlobArray>(
        nameOf(i) + "/ir_blobs", 100,
        [to = &arrivals.back()](const wiimote_tracker_msgs::IrBlobArray::ConstPtr& message) {
          to->add(*message);
        }));
  }
  ros::AsyncSpinner spinner(1);
  spinner.start();
  nodelet::Loader loader(false);
  load(loader, remotes, folder.path());

  const double limit = steadyNow() + kStartLimit;
  const auto warm = [](const Arrivals& a) { return a.received() > kWarmUp; };
  while (!std::all_of(arrivals.begin(), arrivals.end(), warm)) {
    if (steadyNow() > limit)
      throw std::runtime_error("not all virtual remotes stream after a minute: use fewer of them");
    wait(0.1);
  }

  const double from = steadyNow();
  const double processor_before = processorTime();
  wait(duration);
  const double processor_time = (processorTime() - processor_before) / (steadyNow() - from);
  const double to = steadyNow() - kUnderWay;
  spinner.stop();
  const Results results = evaluate(remotes, arrivals, from, to, processor_time);
  loader.clear();
  ros::shutdown();
  return results;
}

}  // namespace wiimote_tracker
