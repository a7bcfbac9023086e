#ifndef WIIMOTE_TRACKER_CALIBRATION_SQUARE_SQUARE_LAYOUT_H
#define WIIMOTE_TRACKER_CALIBRATION_SQUARE_SQUARE_LAYOUT_H

#include <Eigen/Core>

#include <array>

namespace wiimote_tracker::square {

/// World points of the four corners, in the order of capture [m].
using Corners = std::array<Eigen::Vector3d, 4>;

/// The calibration rectangle and where the world lies in it. The rectangle's own axes: origin at
/// the first corner, x towards the second, y towards the fourth.
struct SquareLayout {
  double side_x = 0.0;      ///< First to second corner [m, > 0].
  double side_y = 0.0;      ///< Second to third corner [m, > 0].
  double led_height = 0.0;  ///< Of the LED above the floor (the plane z = 0) [m, >= 0].
  Eigen::Vector2d origin =
      Eigen::Vector2d::Zero();  ///< World's origin in the rectangle's axes [m].
  double yaw = 0.0;  ///< From the rectangle's x axis to the world's x axis, about z [rad].

  /// @throws SquareError naming the value that is not finite or out of range.
  void check() const;

  /// @param z_up the corners go round counter-clockwise seen from above. Otherwise z points down
  /// and the LED, still above the floor, has negative z.
  Corners corners(bool z_up) const;
};

}  // namespace wiimote_tracker::square

#endif  // WIIMOTE_TRACKER_CALIBRATION_SQUARE_SQUARE_LAYOUT_H
