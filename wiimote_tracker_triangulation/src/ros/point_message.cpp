#include "point_message.h"

#include <algorithm>
#include <limits>

namespace wiimote_tracker {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

ros::Time timeOf(double seconds) {
  return ros::Time(std::max(0.0, seconds));
}

wiimote_tracker_msgs::TrackedPoint trackedPoint(const fusion::Instant& instant,
                                                const geometry::Rig& rig,
                                                const PointContext& context) {
  wiimote_tracker_msgs::TrackedPoint point;
  point.id = 0;  // there is one LED
  point.label = context.label;
  point.label_confidence = std::numeric_limits<float>::quiet_NaN();
  point.state = wiimote_tracker_msgs::TrackedPoint::TRACKED;
  point.position.x = instant.point->position.x();
  point.position.y = instant.point->position.y();
  point.position.z = instant.point->position.z();
  point.velocity.x = point.velocity.y = point.velocity.z = kNaN;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c)
      point.position_covariance[3 * r + c] = instant.point->covariance(r, c);
  }
  point.velocity_covariance.fill(kNaN);
  point.rays_used = static_cast<std::uint32_t>(instant.rays_used);
  point.rays_possible = static_cast<std::uint32_t>(instant.rays_possible);
  for (std::size_t i = 0; i < instant.sightings.size(); ++i) {
    if (instant.sightings[i].used)
      point.cameras.push_back(rig.cameras[i].camera.name);
  }
  point.residual = instant.point->reprojection_error;
  point.last_observed = timeOf(instant.last_observed);
  point.age = instant.time - context.first_seen;
  point.remapped = context.remapped;
  return point;
}

}  // namespace

wiimote_tracker_msgs::TrackedPointArray pointMessage(const fusion::Instant& instant,
                                                     const geometry::Rig& rig,
                                                     std::uint64_t late_frames,
                                                     const PointContext& context) {
  wiimote_tracker_msgs::TrackedPointArray message;
  message.header.stamp = timeOf(instant.time);
  message.header.frame_id = rig.world_frame;
  message.rig_id = context.rig_id;
  message.method = context.method;
  message.latest_arrival = timeOf(instant.latest_arrival);
  message.skew = instant.skew;
  message.late_frames = late_frames;
  if (instant.point)
    message.points.push_back(trackedPoint(instant, rig, context));
  return message;
}

}  // namespace wiimote_tracker
