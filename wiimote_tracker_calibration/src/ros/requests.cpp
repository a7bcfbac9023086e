#include "requests.h"

#include <ros/console.h>

#include <new>

namespace wiimote_tracker {

workflow::Reply replyOf(const std::function<workflow::Reply()>& work) {
  std::string reason;
  try {
    return work();
  } catch (const Error& error) {
    return {false, error.what()};
  } catch (const std::bad_alloc&) {
    reason = "the computer has no memory left: close other programs and try again";
  } catch (const std::exception& error) {
    reason = std::string("an unexpected error occurred (") + error.what() +
             "): try again, and report it if it comes back";
  } catch (...) {
    reason = "an unexpected error occurred: try again, and report it if it comes back";
  }
  ROS_ERROR_STREAM(reason);
  return {false, reason};
}

void runCallback(const std::string& name, const std::function<void()>& callback) {
  const workflow::Reply reply = replyOf([&] {
    callback();
    return workflow::Reply{true, ""};
  });
  if (!reply.success)
    ROS_ERROR_STREAM_THROTTLE(10.0, name << " failed: " << reply.message);
}

std::string appendix(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences)
    text += "; " + sentence;
  return text;
}

}  // namespace wiimote_tracker
