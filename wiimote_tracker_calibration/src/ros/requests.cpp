#include "requests.h"

#include <ros/console.h>

#include <new>

namespace wiimote_tracker {

namespace {

/// What is being handled, in words.
std::string reasonOfException() {
  try {
    throw;
  } catch (const Error& error) {
    return error.what();
  } catch (const std::bad_alloc&) {
    return "the computer has no memory left: close other programs and try again";
  } catch (const std::exception& error) {
    return std::string("an unexpected error occurred (") + error.what() +
           "): try again, and report it if it comes back";
  } catch (...) {
    return "an unexpected error occurred: try again, and report it if it comes back";
  }
}

}  // namespace

workflow::Reply replyOf(const std::function<workflow::Reply()>& work) {
  try {
    return work();
  } catch (const Error& error) {
    return {false, error.what()};
  } catch (...) {
    const std::string reason = reasonOfException();
    ROS_ERROR_STREAM(reason);
    return {false, reason};
  }
}

void runCallback(const std::string& name, const std::function<void()>& callback) {
  try {
    callback();
  } catch (...) {
    ROS_ERROR_STREAM_THROTTLE(10.0, name << " failed: " << reasonOfException());
  }
}

std::string appendix(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences)
    text += "; " + sentence;
  return text;
}

}  // namespace wiimote_tracker
