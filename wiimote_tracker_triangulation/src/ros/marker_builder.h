#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_MARKER_BUILDER_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_MARKER_BUILDER_H

#include "wiimote_tracker_triangulation/fusion/instant_fuser.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <visualization_msgs/MarkerArray.h>

#include <deque>
#include <limits>
#include <utility>

namespace wiimote_tracker {

struct MarkerOptions {
  double rate = 20.0;                 ///< Most arrays per second [Hz, > 0].
  double image_plane_distance = 0.5;  ///< Along the optical axis [m, > 0].
  double trail_duration = 10.0;       ///< [s, >= 0].
};

/// Draws a rig and an instant for rviz, in the world frame. Namespaces: camera, frustum,
/// image_plane, blob, ray (one id per camera, in the order of the rig); point, covariance (95 %
/// ellipsoid), trail (id 0).
class MarkerBuilder {
 public:
  explicit MarkerBuilder(const MarkerOptions& options) : options_(options) {}

  /// From now on draws this rig; what was drawn of the last one is taken away.
  void setRig(const geometry::Rig& rig);

  /// Whether 1 / rate has passed since the last array, or time jumped back.
  bool isDue(double time) const;

  visualization_msgs::MarkerArray build(const fusion::Instant& instant);

 private:
  visualization_msgs::Marker marker(const std::string& ns, std::size_t id, int type) const;
  void addCamera(std::size_t index, const fusion::Instant& instant);
  void addPoint(const fusion::Instant& instant);
  void addTrail(const fusion::Instant& instant);

  MarkerOptions options_;
  geometry::Rig rig_;
  bool must_clear_ = false;
  double time_ = -std::numeric_limits<double>::infinity();
  std::deque<std::pair<double, Eigen::Vector3d>> trail_;
  visualization_msgs::MarkerArray array_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_MARKER_BUILDER_H
