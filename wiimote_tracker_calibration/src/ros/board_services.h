#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_BOARD_SERVICES_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_BOARD_SERVICES_H

#include "wiimote_tracker_calibration/intrinsics/board_run.h"

#include "node_context.h"

#include <std_srvs/Trigger.h>
#include <wiimote_tracker_msgs/SolveBoard.h>
#include <wiimote_tracker_msgs/StartBoard.h>

#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// A camera's lens from the 16-LED board: board/start, board/undo, board/cancel, board/solve,
/// board/commit, and the topic board. Goes on beside all else.
class BoardServices {
 public:
  explicit BoardServices(NodeContext* context);

 private:
  bool start(wiimote_tracker_msgs::StartBoard::Request& request,
             wiimote_tracker_msgs::StartBoard::Response& response);
  bool undo(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool cancel(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool solve(wiimote_tracker_msgs::SolveBoard::Request& request,
             wiimote_tracker_msgs::SolveBoard::Response& response);
  bool commit(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  workflow::Reply start(const wiimote_tracker_msgs::StartBoard::Request& request, const Lock& lock);
  void onImage(const capture::Image& image, const Lock& lock);
  void publish(const std::string& message, const Lock& lock);

  NodeContext& context_;
  ros::Publisher publisher_;
  std::vector<ros::ServiceServer> services_;
  // All of the following with the mutex locked.
  std::string camera_;  // that looks at the board; empty: nothing started
  std::optional<intrinsics::BoardRun> run_;
  std::optional<geometry::Intrinsics> lens_;  // solved from these views
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_BOARD_SERVICES_H
