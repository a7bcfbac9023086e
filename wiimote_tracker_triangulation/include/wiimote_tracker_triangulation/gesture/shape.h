#ifndef WIIMOTE_TRACKER_TRIANGULATION_GESTURE_SHAPE_H
#define WIIMOTE_TRACKER_TRIANGULATION_GESTURE_SHAPE_H

#include <Eigen/Core>

#include <limits>
#include <optional>
#include <vector>

namespace wiimote_tracker::gesture {

/// Where an LED was, and when.
struct PathPoint {
  double time;               ///< [s]
  Eigen::Vector3d position;  ///< World [m].
};

/// In the order of time.
using Path = std::vector<PathPoint>;

struct ShapeOptions {
  /// Standard deviation of the Gaussian that takes the jitter off a path [s, >= 0].
  double smoothing = 0.02;

  /// A shorter way is no gesture [m, >= 0].
  double minimum_length = 0.1;
};

/// A path without its place, size and speed.
struct Shape {
  static constexpr int kPoints = 32;

  /// At equal distances along the way; their mean is zero and their mean square norm 1 [1].
  Eigen::Matrix<double, 3, kPoints> positions;

  /// Of the way at each of them, unit length [1].
  Eigen::Matrix<double, 3, kPoints> directions;
};

/// Nothing for what is no gesture: fewer than 5 points, times that do not increase, values that are
/// not finite, or too short a way.
std::optional<Shape> shapeOf(const Path& path, const ShapeOptions& options);

/// A shape turned about the vertical (world z) such that it fits another one best in the sense of
/// least squares, point by point.
Shape turnedTowards(const Shape& shape, const Shape& other);

/// How far two shapes are apart [1, >= 0]: the mean square difference of positions and directions
/// along the best alignment in time (dynamic time warping; Sakoe and Chiba 1978, band of kBand
/// points). Infinity as soon as it is certain to exceed `limit`.
double distance(const Shape& a,
                const Shape& b,
                double limit = std::numeric_limits<double>::infinity());

/// Points by which one shape may run ahead of the other in distance().
constexpr int kBand = 3;

}  // namespace wiimote_tracker::gesture

#endif  // WIIMOTE_TRACKER_TRIANGULATION_GESTURE_SHAPE_H
