#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_REPLIES_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_REPLIES_H

#include "wiimote_tracker_calibration/workflow/calibration.h"

#include <string>
#include <vector>

namespace wiimote_tracker {

/// Puts a reply into the fields that all services' responses have.
template <typename Response>
void fill(const workflow::Reply& reply, Response* response) {
  response->success = reply.success;
  response->message = reply.message;
}

/// "; first; second".
inline std::string joined(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences)
    text += "; " + sentence;
  return text;
}

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_REPLIES_H
