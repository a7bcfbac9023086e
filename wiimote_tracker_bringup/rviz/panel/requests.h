#ifndef WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_REQUESTS_H
#define WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_REQUESTS_H

#include "guide.h"

#include <ros/service_client.h>

#include <atomic>
#include <list>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

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

  /// One at a time; while one runs, only kCancel is accepted.
  void send(const Request& request);
  void poll();

 private:
  struct Event {
    std::list<std::thread>::iterator thread;  // that has answered; end(): none
    Command command;
    std::string text;
    double progress;
  };
  /// What the node said, or why it said nothing.
  std::string perform(const Request& request);
  template <class Service>
  std::string call(const std::string& name, Service service);
  std::string captureCorner(const Request& request);
  bool mustEnd();
  void report(const Event& event);

  Guide* guide_;
  std::list<std::thread> threads_;
  std::mutex mutex_;
  std::vector<Event> events_;
  std::list<ros::ServiceClient> clients_;   // that wait for an answer
  std::atomic<bool> is_called_off_{false};  // the corner that is captured
  bool must_end_ = false;
};

}  // namespace wiimote_tracker::panel

#endif  // WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_REQUESTS_H
