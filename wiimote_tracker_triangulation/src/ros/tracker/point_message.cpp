#include "point_message.h"

#include <cmath>
#include <limits>

namespace wiimote_tracker {
namespace {

using wiimote_tracker_msgs::TrackedPoint;
using wiimote_tracker_msgs::TrackedPointArray;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

static_assert(static_cast<int>(tracking::TrackState::kTentative) == TrackedPoint::TENTATIVE &&
                  static_cast<int>(tracking::TrackState::kTracked) == TrackedPoint::TRACKED &&
                  static_cast<int>(tracking::TrackState::kPredicted) == TrackedPoint::PREDICTED &&
                  static_cast<int>(tracking::TrackState::kLost) == TrackedPoint::LOST,
              "enumerations of core and messages must agree");

}  // namespace

TrackedPoint trackedPoint(const tracking::TrackedLed& led,
                          double time,
                          const geometry::Rig& rig,
                          const identity::LedLabels& labels) {
  TrackedPoint point;
  point.id = led.id;
  const identity::LedLabel label = labels.of(led.id);
  point.label = label.name;
  point.label_confidence = static_cast<float>(label.confidence);
  point.label_since = timeOf(label.since);
  point.state = static_cast<std::uint8_t>(led.state);
  setVector(led.position, &point.position);
  setMatrix(led.position_covariance, &point.position_covariance);
  setVector(led.velocity.value_or(Eigen::Vector3d::Constant(kNaN)), &point.velocity);
  setMatrix(
      led.velocity ? led.velocity_covariance : Eigen::Matrix3d(Eigen::Matrix3d::Constant(kNaN)),
      &point.velocity_covariance);
  point.rays_used = static_cast<std::uint32_t>(led.cameras.size());
  point.rays_possible = static_cast<std::uint32_t>(led.rays_possible);
  for (const std::size_t camera : led.cameras)
    point.cameras.push_back(rig.cameras[camera].camera.name);
  point.residual = led.residual;
  point.last_observed = timeOf(led.last_observed);
  point.age = time - led.first_seen;
  point.remapped = led.remapped;
  return point;
}

TrackedPointArray pointMessage(const tracking::Snapshot& snapshot,
                               const geometry::Rig& rig,
                               const identity::LedLabels& labels) {
  TrackedPointArray message;
  message.header.stamp = timeOf(snapshot.time);
  message.header.frame_id = rig.world_frame;
  message.latest_arrival = timeOf(snapshot.latest_arrival);
  message.skew = snapshot.skew;
  message.points.reserve(snapshot.leds.size());
  for (const tracking::TrackedLed& led : snapshot.leds)
    message.points.push_back(trackedPoint(led, snapshot.time, rig, labels));
  return message;
}

nav_msgs::Odometry odometry(const TrackedPointArray& array, const TrackedPoint& point) {
  nav_msgs::Odometry message;
  message.header = array.header;
  message.child_frame_id = point.label;
  message.pose.pose.position = point.position;
  message.pose.pose.orientation.w = 1.0;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  Matrix6 covariance = kUnknownVariance * Matrix6::Identity();
  covariance.topLeftCorner<3, 3>() = matrixOf<3>(point.position_covariance);
  setMatrix(covariance, &message.pose.covariance);
  const bool has_velocity = !std::isnan(point.velocity.x);
  if (has_velocity)
    message.twist.twist.linear = point.velocity;
  covariance.topLeftCorner<3, 3>() =
      has_velocity ? matrixOf<3>(point.velocity_covariance)
                   : Eigen::Matrix3d(kUnknownVariance * Eigen::Matrix3d::Identity());
  setMatrix(covariance, &message.twist.covariance);
  return message;
}

}  // namespace wiimote_tracker
