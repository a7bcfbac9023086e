#include "wiimote_tracker_calibration/square/square_layout.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>
#include "square/error.h"

#include <cmath>
#include <string>

namespace wiimote_tracker::square {

namespace {

void checkSide(const std::string& which, double length) {
  if (!std::isfinite(length) || length <= 0.0)
    throw SquareError("the side of the square from the " + which + " corner is " +
                      std::to_string(length) +
                      " m, but must be greater than 0: measure it and give it in metres");
}

void checkLength(const TapedLength& taped) {
  const auto positive = [](double value) { return std::isfinite(value) && value > 0.0; };
  if (taped.from > 3 || taped.to > 3 || taped.from == taped.to)
    throw SquareError("a length is between two different corners out of four: correct the corners");
  if (!positive(taped.length) || !positive(taped.stddev))
    throw SquareError("the length between corner " + std::to_string(taped.from + 1) +
                      " and corner " + std::to_string(taped.to + 1) +
                      ", or its standard deviation, is not above 0: give it in metres");
}

}  // namespace

void SquareLayout::check() const {
  checkSide("first to the second", side_x);
  checkSide("second to the third", side_y);
  if (!std::isfinite(led_height) || led_height < 0.0)
    throw SquareError("the height of the LED above the floor is " + std::to_string(led_height) +
                      " m, but must be 0 or greater: measure it and give it in metres");
  if (!origin.allFinite() || !std::isfinite(yaw))
    throw SquareError("the offset of the world to the square is not a number: correct the offset");
  for (const TapedLength& taped : lengths)
    checkLength(taped);
  for (const KnownPlace& place : places) {
    if (!place.position.allFinite() || !std::isfinite(place.stddev) || place.stddev <= 0.0)
      throw SquareError(
          "a known place is not finite, or its standard deviation not above 0: give metres");
  }
}

Corners SquareLayout::corners(bool z_up) const {
  const double z = z_up ? led_height : -led_height;
  const Eigen::Rotation2Dd world_from_square(-yaw);
  const std::array<Eigen::Vector2d, 4> in_square = {
      Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(side_x, 0.0), Eigen::Vector2d(side_x, side_y),
      Eigen::Vector2d(0.0, side_y)};
  Corners corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d in_world = world_from_square * (in_square[i] - origin);
    corners[i] = Eigen::Vector3d(in_world.x(), in_world.y(), z);
  }
  return corners;
}

void SquareLayout::describeIn(geometry::Rig* rig) const {
  rig->square_sides = {side_x, side_y};
  rig->square_pose = geometry::SquarePose{origin, yaw};
  rig->led_height = led_height;
}

}  // namespace wiimote_tracker::square
