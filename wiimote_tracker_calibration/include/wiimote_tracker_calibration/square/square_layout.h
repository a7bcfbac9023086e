#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace wiimote_tracker::geometry {
struct Rig;
}

namespace wiimote_tracker::square {

/// World points of the four corners, in the order of capture [m].
using Corners = std::array<Eigen::Vector3d, 4>;

/// Default of a member: Corners{} would leave its numbers unset, as Eigen does.
inline Corners zeroCorners() {
  Corners corners;
  corners.fill(Eigen::Vector3d::Zero());
  return corners;
}

/// Parameters of the corners in a joint covariance, after those of the cameras: the horizontal
/// displacement of each, x and y.
constexpr Eigen::Index kCornerParameters = 8;

/// A length between two corners, by tape, from where the LED lay to where it lay.
struct TapedLength {
  std::size_t from = 0;   ///< Corner, 0..3.
  std::size_t to = 0;     ///< Another corner.
  double length = 0.0;    ///< [m, > 0]
  double stddev = 0.001;  ///< [m, > 0]

  /// Whether both are between the same corners.
  bool hasCornersOf(const TapedLength& other) const {
    return (from == other.from && to == other.to) || (from == other.to && to == other.from);
  }
};

/// A place that the LED was put on, known in the world by other means, to solve with (service
/// measure_place). The services known_places/... measure remap::KnownPoint with a solved rig.
struct KnownPlace {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< World [m].
  double stddev = 0.001;                               ///< Per axis [m, > 0].
};

/// The calibration rectangle and where the world lies in it. The rectangle's own axes: origin at
/// the first corner, x towards the second, y towards the fourth.
struct SquareLayout {
  double side_x = 0.0;      ///< First to second corner [m, > 0].
  double side_y = 0.0;      ///< Second to third corner [m, > 0].
  double led_height = 0.0;  ///< Of the LED above the floor (the plane z = 0) [m, >= 0].
  /// World's origin in the rectangle's axes [m].
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  double yaw = 0.0;  ///< From the rectangle's x axis to the world's x axis, about z [rad].
  std::vector<TapedLength> lengths = {};
  std::vector<KnownPlace> places = {};

  /// @throws SquareError naming the value that is not finite or out of range.
  void check() const;

  /// Length between two corners by the sides [m].
  double lengthBetween(std::size_t from, std::size_t to) const {
    const Corners all = corners(true);
    return (all[to] - all[from]).norm();
  }

  /// @param z_up the corners go round counter-clockwise seen from above. Otherwise z points down
  /// and the LED, still above the floor, has negative z.
  Corners corners(bool z_up) const;

  /// Notes in the rig that it was calibrated with this square.
  void describeIn(geometry::Rig* rig) const;
};

}  // namespace wiimote_tracker::square
