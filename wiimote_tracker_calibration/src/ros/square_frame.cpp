#include "square_frame.h"

#include <tf2_eigen/tf2_eigen.h>

namespace wiimote_tracker {

namespace {

geometry_msgs::Point32 point(double x, double y) {
  geometry_msgs::Point32 point;
  point.x = static_cast<float>(x);
  point.y = static_cast<float>(y);
  return point;
}

}  // namespace

geometry_msgs::TransformStamped squareTransform(const workflow::CalibrationOptions& options) {
  const Eigen::AngleAxisd world_from_square(-options.yaw, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d origin_in_square(options.origin.x(), options.origin.y(), 0.0);
  geometry_msgs::TransformStamped transform = tf2::eigenToTransform(
      Eigen::Isometry3d(world_from_square * Eigen::Translation3d(-origin_in_square)));
  transform.header.frame_id = options.world_frame;
  transform.child_frame_id = options.world_frame + "_square";
  return transform;
}

geometry_msgs::PolygonStamped squareOutline(const workflow::CalibrationOptions& options,
                                            const std::vector<double>& sides) {
  geometry_msgs::PolygonStamped outline;
  outline.header.frame_id = options.world_frame + "_square";
  if (sides.size() == 2)
    outline.polygon.points = {point(0.0, 0.0), point(sides[0], 0.0), point(sides[0], sides[1]),
                              point(0.0, sides[1])};
  return outline;
}

}  // namespace wiimote_tracker
