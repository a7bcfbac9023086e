#pragma once

#include "waiting.h"
#include "wiimote_tracker_driver/virtual_wiimote/server.h"

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace wiimote_tracker::driver {

/// A virtual remote with a realistic clock: images at start() + n * kPeriod, reported after a
/// delay. Senses the same thing until changed.
class Remote {
 public:
  static constexpr double kPeriod = 0.010035;  // [s]
  static constexpr double kDelay = 0.008;      // [s]

  /// The events of image n.
  struct Instant {
    virtual_wiimote::Senses senses;
    double delay = kDelay;  ///< Of its report [s].
  };

  Remote(const std::string& path, const std::string& identity)
      : server(path, identity, virtual_wiimote::Device::Options()),
        start_(steadyNow()),
        thread_([this] { run(); }) {}
  ~Remote() {
    stop_ = true;
    thread_.join();
  }

  void sense(const virtual_wiimote::Senses& senses) {
    play([senses](std::uint64_t) { return Instant{senses, kDelay}; });
  }

  /// Senses what `script` returns for each image.
  void play(std::function<Instant(std::uint64_t)> script) {
    const std::lock_guard<std::mutex> lock(mutex_);
    script_ = std::move(script);
  }

  /// Exposure of image n on the steady clock [s].
  double exposure(std::uint64_t n) const { return start_ + static_cast<double>(n) * kPeriod; }

  virtual_wiimote::Server server;

 private:
  void run() {
    for (std::uint64_t n = 0; !stop_; ++n) {
      Instant instant;
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        instant = script_(n);
      }
      std::this_thread::sleep_for(
          std::chrono::duration<double>(exposure(n) + instant.delay - steadyNow()));
      server.sample(instant.senses);
    }
  }

  const double start_;
  std::mutex mutex_;
  std::function<Instant(std::uint64_t)> script_ = [](std::uint64_t) { return Instant(); };
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// Handles callbacks until the condition holds; false after 20 s.
template <typename Condition>
bool spinUntil(Condition condition) {
  for (const double deadline = steadyNow() + 20.0; !condition();) {
    if (steadyNow() > deadline || !ros::ok())
      return false;
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
  }
  return true;
}

/// All messages of a topic since construction.
template <typename M>
struct Recorder {
  explicit Recorder(const std::string& topic)
      : subscriber(ros::NodeHandle().subscribe<M>(
            topic,
            1000,
            [this](const boost::shared_ptr<const M>& message) { messages.push_back(*message); })) {}
  bool any() const { return !messages.empty(); }
  const M& last() const { return messages.back(); }

  std::vector<M> messages;
  ros::Subscriber subscriber;
};

}  // namespace wiimote_tracker::driver
