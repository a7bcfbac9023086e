#include "rooms/room_accuracy.h"

#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <cmath>

namespace wiimote_tracker::rooms {

namespace {

constexpr double kWantedPosition = 0.05;  // [m]
constexpr double kWantedRotation = 0.5;   // [degrees]

double degrees(double angle) {
  return angle * 180.0 / M_PI;
}

}  // namespace

bool RoomAccuracy::isAsWanted() const {
  return position <= kWantedPosition && degrees(rotation) <= kWantedRotation;
}

std::string wantedAccuracy() {
  return format("%.0f cm and %.1f degrees", 100.0 * kWantedPosition, kWantedRotation);
}

RoomAccuracy accuracyOf(const RigMotion& motion, const Eigen::Vector3d& point) {
  Eigen::Matrix<double, 6, 6> by_motion = Eigen::Matrix<double, 6, 6>::Identity();
  by_motion.block<3, 3>(3, 0) = -geometry::so3::skew(motion.first_from_second.linear() * point);
  const Eigen::VectorXd variances =
      geometry::propagated(by_motion * motion.by_errors, motion.error_covariance).diagonal();
  return {std::sqrt(variances.tail<3>().sum()), std::sqrt(variances.head<3>().sum())};
}

Eigen::Vector3d middleOfSecond(const geometry::Rig& first, const geometry::Rig& second) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const geometry::RigCamera& camera : second.cameras) {
    if (first.find(camera.camera.name))
      continue;
    sum += camera.camera.center();
    ++count;
  }
  return sum / count;
}

std::string describe(const RoomAccuracy& accuracy) {
  return format(
      "the second room is known to %.1f cm at the middle of its cameras, and %.2f degrees "
      "(standard deviations, to which the errors within the second rig add: see its verdict)",
      100.0 * accuracy.position, degrees(accuracy.rotation));
}

}  // namespace wiimote_tracker::rooms
