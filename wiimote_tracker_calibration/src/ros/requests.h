#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_REQUESTS_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_REQUESTS_H

#include "workflow/reply.h"

#include <wiimote_tracker_msgs/error.h>

#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Proof that the node's mutex is locked.
using Lock = std::unique_lock<std::mutex>;

/// A request cannot be done now. what() is one sentence: why, and what to do.
struct Refusal : Error {
  using Error::Error;
};

/// What `work` returns. Anything that it throws becomes a refusal in words.
workflow::Reply replyOf(const std::function<workflow::Reply()>& work);

/// Runs a callback from which nothing may escape; what it throws is logged with this name.
void runCallback(const std::string& name, const std::function<void()>& callback);

/// Offers a service. Its handler returns the reply, and fills the other fields of the response.
template <typename Request, typename Response, typename Handler>
ros::ServiceServer offer(ros::NodeHandle nh, const std::string& name, const Handler& handler) {
  return nh.advertiseService<Request, Response>(
      name, [handler](Request& request, Response& response) {
        const workflow::Reply reply = replyOf([&] { return handler(request, &response); });
        response.success = reply.success;
        response.message = reply.message;
        return true;
      });
}

/// Same for a function of a unit.
template <typename Unit, typename Request, typename Response>
ros::ServiceServer advertise(const ros::NodeHandle& nh,
                             const std::string& name,
                             workflow::Reply (Unit::*handler)(const Request&, Response*),
                             Unit* unit) {
  return offer<Request, Response>(nh, name, [=](const Request& request, Response* response) {
    return (unit->*handler)(request, response);
  });
}

/// Same without fields in the request.
template <typename Unit>
ros::ServiceServer advertise(const ros::NodeHandle& nh,
                             const std::string& name,
                             workflow::Reply (Unit::*handler)(),
                             Unit* unit) {
  using std_srvs::Trigger;
  return offer<Trigger::Request, Trigger::Response>(
      nh, name, [=](const Trigger::Request&, Trigger::Response*) { return (unit->*handler)(); });
}

/// Scope guard: runs `call` at the end of its scope, also when an exception ends it.
template <typename Call>
struct AtEnd {
  Call call;
  ~AtEnd() { call(); }
};
template <typename Call>
AtEnd(Call) -> AtEnd<Call>;

/// "; first; second".
std::string appendix(const std::vector<std::string>& sentences);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_REQUESTS_H
