#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_BODIES_BODY_MARKERS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_BODIES_BODY_MARKERS_H

#include "../marker_parts.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <visualization_msgs/MarkerArray.h>
#include <wiimote_tracker_msgs/TrackedBodyArray.h>

#include <cstddef>
#include <limits>
#include <map>
#include <string>

namespace wiimote_tracker {

/// Markers of bodies for rviz, in the world frame. Namespaces, with one id per body in the order of
/// appearance: body_axes (x red, y green, z blue), body_shape (lines from the origin to the LEDs),
/// body_led, body_label, body_led_label (LED i: 8 id + i), body_ray (from each camera to the LEDs
/// it sees). Predicted bodies and unseen LEDs are pale.
class BodyMarkers {
 public:
  /// @param rate most arrays per second [Hz, > 0].
  explicit BodyMarkers(double rate) : period_(1.0 / rate) {}

  void setRig(const geometry::Rig& rig) { rig_ = rig; }

  /// Whether a period has passed since the last array, or time jumped back.
  bool isDue(double time) const { return time >= time_ + period_ || time < time_; }

  visualization_msgs::MarkerArray build(const wiimote_tracker_msgs::TrackedBodyArray& bodies);

 private:
  void addBody(const wiimote_tracker_msgs::TrackedBody& body, std::size_t id);
  void addLeds(const wiimote_tracker_msgs::TrackedBody& body, std::size_t id);

  double period_;  // [s]
  geometry::Rig rig_;
  double time_ = -std::numeric_limits<double>::infinity();
  std::map<std::string, std::size_t> ids_;  // by name
  markers::Common common_;
  visualization_msgs::MarkerArray array_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_BODIES_BODY_MARKERS_H
