#include "measurement_message.h"

#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <string>

namespace wiimote_tracker {
namespace {

using wiimote_tracker_msgs::TrackedPoint;

std::string wordOf(std::uint8_t state) {
  switch (state) {
    case TrackedPoint::TENTATIVE:
      return "tentative";
    case TrackedPoint::TRACKED:
      return "tracked";
    case TrackedPoint::PREDICTED:
      return "predicted";
    case TrackedPoint::LOST:
      return "lost";
  }
  return std::to_string(state);  // of a later version of the message
}

std::int64_t nanoseconds(const ros::Time& time) {
  return static_cast<std::int64_t>(time.toNSec());
}

}  // namespace

void writeMeasurements(const wiimote_tracker_msgs::TrackedPointArray& points,
                       bool triggered,
                       measurements::Writer* writer) {
  measurements::Measurement m;
  m.stamp = nanoseconds(points.header.stamp);
  m.triggered = triggered;
  m.frame = points.header.frame_id;
  m.rig_id = points.rig_id;
  m.method = points.method;
  for (const TrackedPoint& point : points.points) {
    m.id = point.id;
    m.label = point.label;
    m.label_confidence = point.label_confidence;
    m.label_since = nanoseconds(point.label_since);
    m.state = wordOf(point.state);
    m.position = vectorOf(point.position);
    m.position_covariance = matrixOf<3>(point.position_covariance);
    m.velocity = vectorOf(point.velocity);
    m.velocity_covariance = matrixOf<3>(point.velocity_covariance);
    m.rays_used = point.rays_used;
    m.rays_possible = point.rays_possible;
    m.residual = point.residual;
    m.last_observed = nanoseconds(point.last_observed);
    m.age = point.age;
    m.remapped = point.remapped;
    writer->add(m);
  }
}

}  // namespace wiimote_tracker
