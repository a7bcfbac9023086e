#ifndef WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_REQUESTS_H
#define WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_REQUESTS_H

#include "guide.h"

#include <ros/service_client.h>

#include <atomic>
#include <functional>
#include <future>
#include <list>
#include <mutex>
#include <optional>
#include <string>

namespace wiimote_tracker::panel {

/// Calls the calibration node's services, each in a thread of its own, so that nobody waits. What
/// comes back is told to the Guide by poll().
class Requests {
 public:
  explicit Requests(Guide* guide) : guide_(guide) {}
  /// Gives up what has not been answered.
  ~Requests();
  Requests(const Requests&) = delete;
  Requests& operator=(const Requests&) = delete;

  /// One at a time; while one runs, only cancel is accepted.
  void send(const Request& request);
  void poll();

 private:
  struct Sent {
    std::string service;
    std::future<std::string> answer;
  };
  struct Progress {
    std::string text;
    double share;  // [0..1]
  };
  /// What the node said, or why it said nothing.
  std::string perform(const Request& request);
  template <class Service>
  std::string call(const std::string& name,
                   const std::function<void(typename Service::Request&)>& fill = {});
  std::string captureCorner(const Request& request);
  bool mustEnd();

  Guide* guide_;
  std::mutex mutex_;
  std::optional<Progress> progress_;        // not told yet
  std::list<ros::ServiceClient> clients_;   // that wait for an answer
  std::atomic<bool> is_called_off_{false};  // the corner that is captured
  bool must_end_ = false;
  std::list<Sent> sent_;  // the newest first; to destroy its future waits for its thread
};

}  // namespace wiimote_tracker::panel

#endif  // WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_REQUESTS_H
