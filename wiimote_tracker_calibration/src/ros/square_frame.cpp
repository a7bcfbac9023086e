#include "square_frame.h"

#include <tf2_eigen/tf2_eigen.h>

namespace wiimote_tracker {

std::optional<square::SquareLayout> squareOf(const geometry::Rig& rig) {
  if (rig.square_sides.size() != 2 || !rig.square_pose)
    return std::nullopt;
  square::SquareLayout square;
  square.side_x = rig.square_sides[0];
  square.side_y = rig.square_sides[1];
  square.origin = rig.square_pose->origin;
  square.yaw = rig.square_pose->yaw;
  return square;
}

geometry_msgs::TransformStamped squareTransform(const std::string& world_frame,
                                                const square::SquareLayout& square) {
  const Eigen::AngleAxisd world_from_square(-square.yaw, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d origin_in_square(square.origin.x(), square.origin.y(), 0.0);
  geometry_msgs::TransformStamped transform = tf2::eigenToTransform(
      Eigen::Isometry3d(world_from_square * Eigen::Translation3d(-origin_in_square)));
  transform.header.frame_id = world_frame;
  transform.child_frame_id = world_frame + "_square";
  return transform;
}

geometry_msgs::PolygonStamped squareOutline(const std::string& world_frame,
                                            const std::optional<square::SquareLayout>& square) {
  geometry_msgs::PolygonStamped outline;
  outline.header.frame_id = world_frame;
  if (!square)
    return outline;
  for (const Eigen::Vector3d& corner : square->corners(true)) {
    geometry_msgs::Point32 point;
    point.x = static_cast<float>(corner.x());
    point.y = static_cast<float>(corner.y());
    outline.polygon.points.push_back(point);
  }
  return outline;
}

}  // namespace wiimote_tracker
