#pragma once

#include "capture/walk.h"
#include "continuous/proposal.h"
#include "health/health_watch.h"
#include "samples/verdict.h"
#include "workflow/calibration.h"
#include "workflow/next_step.h"
#include "workflow/sounds.h"

#include "camera_inputs.h"
#include "parameters.h"

#include <geometry_msgs/PolygonStamped.h>
#include <ros/node_handle.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <wiimote_tracker_msgs/CalibrationCameraStatus.h>

#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Publishes where the calibration stands: calibration/status, the square and the sounds. Keeps
/// what the status shows besides the calibration: the walk, and the health of the cameras. All with
/// the node's mutex locked.
class StatusPublisher {
 public:
  /// What it shows, and the broadcaster, outlive it.
  StatusPublisher(const Parameters& parameters,
                  const workflow::Calibration& calibration,
                  ros::NodeHandle* nh,
                  CameraInputs* inputs,
                  tf2_ros::StaticTransformBroadcaster* transforms);
  StatusPublisher(const StatusPublisher&) = delete;
  StatusPublisher& operator=(const StatusPublisher&) = delete;

  /// Forgets what the cameras saw of a carried LED, and collects it also for the rig in use.
  void beginWalk();
  /// With a rig in use its LED is tracked instead.
  void endWalk() { walk_is_wanted_ = false; }

  /// What is found of the cameras' health from now on, by their names.
  void setHealth(const std::map<std::string, health::CameraHealth>& healths) { health_ = healths; }

  /// What continuous calibration proposes to change, and how; instead of other advice it is shown
  /// with the health of these cameras.
  void setProposal(const continuous::Proposal& proposal, const std::string& text) {
    correctable_ = proposal.cameras;
    cause_ = proposal.cause;
    proposal_text_ = text;
  }
  void forgetProposal() { correctable_.clear(); }
  /// CalibrationCameraStatus.health of a camera.
  std::string health(const std::string& camera) const;

  /// What each camera shows over the last `window` seconds, and what it has contributed so far.
  std::vector<wiimote_tracker_msgs::CalibrationCameraStatus> cameras(double window) const;

  /// @param verdict of the rig in use.
  void publish(const samples::Verdict& verdict);

 private:
  /// A walk comes before the start.
  bool isWalked() const;
  workflow::Findings findings() const;
  /// Publishes what has just happened, for the ears.
  void publishSound();
  /// Publishes the square, when its sides have changed.
  void publishSquare();

  const Parameters& parameters_;
  const workflow::Calibration& calibration_;
  const CameraInputs& inputs_;
  tf2_ros::StaticTransformBroadcaster& transforms_;
  ros::Publisher status_publisher_;
  ros::Publisher square_publisher_;
  ros::Publisher sound_publisher_;
  workflow::Sounds sounds_;
  geometry_msgs::PolygonStamped outline_;  // of the square, as published
  capture::Walk walk_;
  bool walk_is_wanted_ = false;  // though there is a rig
  std::map<std::string, health::CameraHealth> health_;
  std::vector<std::string> correctable_;  // By what is proposed.
  continuous::Cause cause_{};
  std::string proposal_text_;
};

}  // namespace wiimote_tracker
