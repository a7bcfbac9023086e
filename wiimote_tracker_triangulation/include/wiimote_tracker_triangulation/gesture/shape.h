#pragma once

#include <Eigen/Core>

#include <limits>
#include <optional>
#include <vector>

namespace wiimote_tracker::gesture {

/// Position of an LED at a time.
struct PathPoint {
  double time;               ///< [s]
  Eigen::Vector3d position;  ///< World [m].
};

/// Sorted by time.
using Path = std::vector<PathPoint>;

struct ShapeOptions {
  /// Standard deviation of the Gaussian that smooths a path [s, >= 0].
  double smoothing = 0.02;

  /// Shorter paths are refused [m, >= 0].
  double minimum_length = 0.1;
};

/// A path normalised for position, size and speed.
struct Shape {
  static constexpr int kPoints = 32;

  /// At equal arc lengths, with zero mean and mean square norm 1 [1].
  Eigen::Matrix<double, 3, kPoints> positions;

  /// Unit tangents at these positions [1].
  Eigen::Matrix<double, 3, kPoints> directions;
};

/// Nothing for a path with fewer than 5 points, times that do not increase, values that are not
/// finite, or a length below ShapeOptions::minimum_length.
std::optional<Shape> shapeOf(const Path& path, const ShapeOptions& options);

/// Rotates a shape about the vertical (world z) to fit another one best (least squares, point by
/// point).
Shape turnedTowards(const Shape& shape, const Shape& other);

/// Distance of two shapes [1, >= 0]: sum of squared differences of positions and directions along
/// the best alignment in time, over kPoints (dynamic time warping; Sakoe and Chiba 1978, but all
/// steps of weight 1; band of kBand points). Infinity once it must exceed `limit`.
double distance(const Shape& a,
                const Shape& b,
                double limit = std::numeric_limits<double>::infinity());

/// Greatest shift between the points of two shapes in distance().
constexpr int kBand = 8;

}  // namespace wiimote_tracker::gesture
