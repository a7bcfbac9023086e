#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_CALIBRATION_NODE_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_CALIBRATION_NODE_H

#include "board_services.h"
#include "capture_services.h"
#include "file_services.h"
#include "health_monitor.h"
#include "mask_services.h"
#include "node_context.h"
#include "place_services.h"
#include "recalibrate_services.h"
#include "solve_services.h"
#include "wave_services.h"

#include <ros/node_handle.h>

namespace wiimote_tracker {

/// The calibration node: what its units share, and one unit per subject. Spin it with several
/// threads: services wait for images.
class CalibrationNode {
 public:
  CalibrationNode(const ros::NodeHandle& nh, const Parameters& parameters);
  ~CalibrationNode();

  NodeContext& context() { return context_; }

 private:
  NodeContext context_;
  FileServices files_{&context_};
  CaptureServices capture_{&context_};
  WaveServices wave_{&context_};
  MaskServices masks_{&context_};
  SolveServices solve_{&context_};
  BoardServices board_{&context_};
  PlaceServices place_{&context_};
  RecalibrateServices recalibrate_{&context_};
  HealthMonitor health_{&context_};
  ros::WallTimer status_timer_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_CALIBRATION_NODE_H
