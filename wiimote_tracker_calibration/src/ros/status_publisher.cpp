#include "status_publisher.h"

#include "camera_status.h"
#include "square_frame.h"

#include <std_msgs/String.h>
#include <wiimote_tracker_msgs/CalibrationStatus.h>

#include <algorithm>
#include <cstdint>
#include <optional>

namespace wiimote_tracker {

StatusPublisher::StatusPublisher(const Parameters& parameters,
                                 const workflow::Calibration& calibration,
                                 ros::NodeHandle* nh,
                                 CameraInputs* inputs,
                                 tf2_ros::StaticTransformBroadcaster* transforms)
    : parameters_(parameters),
      calibration_(calibration),
      inputs_(*inputs),
      transforms_(*transforms),
      status_publisher_(
          nh->advertise<wiimote_tracker_msgs::CalibrationStatus>("calibration/status", 1, true)),
      square_publisher_(
          nh->advertise<geometry_msgs::PolygonStamped>("calibration/square", 1, true)),
      sound_publisher_(nh->advertise<std_msgs::String>("calibration/sound", 10)) {
  // Before a calibration, too, so that the world is a frame that others can show.
  transforms_.sendTransform(
      squareTransform(parameters.calibration.world_frame, parameters.calibration.layout));
  inputs->subscribeImages([this](const capture::Image& image, const Lock&) {
    const CameraInput& camera = inputs_.cameras().at(image.camera);
    if (isWalked() && camera.width > 0 && camera.height > 0)
      walk_.add(image, camera.width, camera.height);
  });
}

void StatusPublisher::beginWalk() {
  walk_.restart();
  walk_is_wanted_ = true;
}

bool StatusPublisher::isWalked() const {
  return calibration_.cameras().empty() && (!calibration_.rig() || walk_is_wanted_);
}

std::string StatusPublisher::health(const std::string& camera) const {
  const auto found = health_.find(camera);
  const std::string finding = found != health_.end() ? found->second : "";
  if (std::count(proposal_.first.begin(), proposal_.first.end(), camera) == 0)
    return finding;
  return finding + (finding.empty() ? "" : "; ") + proposal_.second;
}

std::vector<wiimote_tracker_msgs::CalibrationCameraStatus> StatusPublisher::cameras(
    double window) const {
  std::vector<wiimote_tracker_msgs::CalibrationCameraStatus> cameras =
      cameraStatus(calibration_, inputs_.cameras(), ros::Time::now().toSec(), window);
  for (wiimote_tracker_msgs::CalibrationCameraStatus& camera : cameras) {
    const auto masks = inputs_.masks().find(camera.name);
    if (masks != inputs_.masks().end())
      camera.masks = static_cast<std::uint32_t>(masks->second.size());
    camera.health = health(camera.name);
    camera.seen_share = walk_.share(camera.name);
    camera.seen_with = walk_.seenWith(camera.name);
  }
  return cameras;
}

void StatusPublisher::publish(const samples::Verdict& verdict) {
  wiimote_tracker_msgs::CalibrationStatus status = calibrationStatus(calibration_, verdict);
  status.header.stamp = ros::Time::now();
  status.header.frame_id = parameters_.calibration.world_frame;
  status.cameras = cameras(1.0);
  if (isWalked())
    status.walk = walk_.sentence();
  status_publisher_.publish(status);
  publishSquare();
  publishSound();
}

void StatusPublisher::publishSound() {
  std_msgs::String sound;
  sound.data = sounds_.heard(calibration_);
  if (parameters_.sounds && !sound.data.empty())
    sound_publisher_.publish(sound);
}

void StatusPublisher::publishSquare() {
  std::optional<square::SquareLayout> square = calibration_.layout();
  std::string world_frame = parameters_.calibration.world_frame;
  if (!square && calibration_.rig()) {
    square = squareOf(*calibration_.rig());
    world_frame = calibration_.rig()->world_frame;
  }
  const geometry_msgs::PolygonStamped outline = squareOutline(world_frame, square);
  if (outline == outline_)
    return;
  outline_ = outline;
  square_publisher_.publish(outline);
  if (square)
    transforms_.sendTransform(squareTransform(world_frame, *square));
}

}  // namespace wiimote_tracker
