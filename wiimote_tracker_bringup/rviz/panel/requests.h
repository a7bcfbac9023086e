#pragma once

#include "guide.h"

#include <ros/node_handle.h>
#include <ros/service_client.h>

#include <atomic>
#include <functional>
#include <future>
#include <list>
#include <mutex>
#include <optional>
#include <string>

namespace wiimote_tracker::panel {

inline constexpr char kNoAnswer[] =
    " does not answer: check that the calibration node runs, in the same version";

class Requests;

/// What a person asks of the calibration node, with what was typed.
struct Request {
  std::string name;  ///< Of the service or action, below calibration/.
  /// Calls it. @returns what the node said, or why it said nothing.
  std::function<std::string(Requests*)> call;
};

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

  // In the thread of a request:
  template <class Service>
  std::string call(const std::string& name, const typename Service::Request& arguments);
  /// @param corner to take again, 0..3; -1: the next one
  std::string captureCorner(int corner);

 private:
  struct Sent {
    std::string name;
    std::future<std::string> answer;
  };
  struct Progress {
    std::string text;
    double share;  // [0..1]
  };
  bool mustEnd();

  Guide* guide_;
  std::mutex mutex_;
  std::optional<Progress> progress_;        // not told yet
  std::list<ros::ServiceClient> clients_;   // that wait for an answer
  std::atomic<bool> is_called_off_{false};  // the corner that is captured
  bool must_end_ = false;
  std::list<Sent> sent_;  // the newest first; to destroy its future waits for its thread
};

/// Of a service. Arguments that are left out stand for the node's own.
template <class Service>
Request requestOf(const std::string& name, const typename Service::Request& arguments = {}) {
  return {name, [=](Requests* requests) { return requests->call<Service>(name, arguments); }};
}

template <class Service>
std::string Requests::call(const std::string& name, const typename Service::Request& arguments) {
  Service service{arguments, {}};
  const std::string full_name = "calibration/" + name;
  // A persistent client, since only such a one can be interrupted.
  ros::ServiceClient client = ros::NodeHandle().serviceClient<Service>(full_name, true);
  std::list<ros::ServiceClient>::iterator place;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (must_end_)
      return "";
    place = clients_.insert(clients_.end(), client);
  }
  const bool is_answered = client.call(service);
  const std::lock_guard<std::mutex> lock(mutex_);
  clients_.erase(place);
  return is_answered ? service.response.message : full_name + kNoAnswer;
}

}  // namespace wiimote_tracker::panel
