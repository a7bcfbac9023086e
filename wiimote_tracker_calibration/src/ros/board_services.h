#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_BOARD_SERVICES_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_BOARD_SERVICES_H

#include "intrinsics/board_run.h"

#include "node_context.h"

#include <wiimote_tracker_msgs/SolveBoard.h>
#include <wiimote_tracker_msgs/StartBoard.h>

#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// A camera's lens from the 16-LED board: board/start, board/undo, board/cancel, board/solve,
/// board/commit, and the topic board. Independent of the calibration's steps.
class BoardServices {
 public:
  explicit BoardServices(NodeContext* context);

 private:
  workflow::Reply start(const wiimote_tracker_msgs::StartBoard::Request& request,
                        wiimote_tracker_msgs::StartBoard::Response* response);
  workflow::Reply undo();
  workflow::Reply cancel();
  workflow::Reply solve(const wiimote_tracker_msgs::SolveBoard::Request& request,
                        wiimote_tracker_msgs::SolveBoard::Response* response);
  workflow::Reply commit();

  /// @throws Refusal: nothing was started.
  intrinsics::BoardRun& run();
  void onImage(const capture::Image& image, const Lock& lock);
  void publish(const std::string& message, const Lock& lock);

  NodeContext& context_;
  ros::Publisher publisher_;
  std::vector<ros::ServiceServer> services_;
  // All of the following with the mutex locked.
  std::string camera_;  // that sees the board; empty: nothing started
  std::optional<intrinsics::BoardRun> run_;
  std::optional<geometry::Intrinsics> lens_;  // solved from these views
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_BOARD_SERVICES_H
