#include "wiimote_tracker_triangulation/gesture/shape.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace wiimote_tracker::gesture {
namespace {

bool isUsable(const Path& path) {
  if (path.size() < 5)
    return false;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (!std::isfinite(path[i].time) || !path[i].position.allFinite())
      return false;
    if (i > 0 && !(path[i].time > path[i - 1].time))
      return false;
  }
  return true;
}

/// Smooths a path by a Gaussian in time. The window narrows towards the ends, which stay in place.
std::vector<Eigen::Vector3d> smoothed(const Path& path, double stddev) {
  std::vector<Eigen::Vector3d> result(path.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double reach =
        std::min({4.0 * stddev, path[i].time - path.front().time, path.back().time - path[i].time});
    Eigen::Vector3d sum = path[i].position;
    double weights = 1.0;
    const auto take = [&](std::size_t k) {
      const double dt = path[k].time - path[i].time;
      if (std::abs(dt) > reach)
        return false;
      const double weight = std::exp(-0.5 * dt * dt / (stddev * stddev));
      sum += weight * path[k].position;
      weights += weight;
      return true;
    };
    for (std::size_t k = i; k-- > 0 && take(k);) {
    }
    for (std::size_t k = i + 1; k < path.size() && take(k); ++k) {
    }
    result[i] = sum / weights;
  }
  return result;
}

/// Points at equal arc lengths of a path of positive length.
Eigen::Matrix<double, 3, Shape::kPoints> resampled(const std::vector<Eigen::Vector3d>& way,
                                                   double length) {
  Eigen::Matrix<double, 3, Shape::kPoints> result;
  std::size_t segment = 0;  // from way[segment] to way[segment + 1]
  double at_segment = 0.0;  // arc length at its start
  for (int i = 0; i < Shape::kPoints; ++i) {
    const double wanted = length * i / (Shape::kPoints - 1);
    double segment_length = (way[segment + 1] - way[segment]).norm();
    while (at_segment + segment_length < wanted && segment + 2 < way.size()) {
      at_segment += segment_length;
      ++segment;
      segment_length = (way[segment + 1] - way[segment]).norm();
    }
    const double share =
        segment_length > 0.0 ? std::min((wanted - at_segment) / segment_length, 1.0) : 0.0;
    result.col(i) = way[segment] + share * (way[segment + 1] - way[segment]);
  }
  return result;
}

}  // namespace

std::optional<Shape> shapeOf(const Path& path, const ShapeOptions& options) {
  if (!isUsable(path))
    return std::nullopt;
  const std::vector<Eigen::Vector3d> way = smoothed(path, options.smoothing);
  double length = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i)
    length += (way[i] - way[i - 1]).norm();
  // Rounding gives a length to a path that does not move.
  const double rounding = 1e-9 * (1.0 + way.front().norm());
  if (length < std::max(options.minimum_length, rounding))
    return std::nullopt;

  Shape shape;
  shape.positions = resampled(way, length);
  for (int i = 0; i < Shape::kPoints; ++i) {
    const Eigen::Vector3d along = shape.positions.col(std::min(i + 1, Shape::kPoints - 1)) -
                                  shape.positions.col(std::max(i - 1, 0));
    // No direction where a path reverses.
    const double norm = along.norm();
    shape.directions.col(i) = norm > 1e-9 * length ? Eigen::Vector3d(along / norm)
                                                   : Eigen::Vector3d(Eigen::Vector3d::Zero());
  }
  const Eigen::Vector3d mean = shape.positions.rowwise().mean();
  shape.positions.colwise() -= mean;
  shape.positions *= std::sqrt(Shape::kPoints / shape.positions.squaredNorm());
  return shape;
}

Shape turnedTowards(const Shape& shape, const Shape& other) {
  // The angle that maximises sum(b . R a) over positions and directions, weighted as in distance().
  double along = 0.0;
  double across = 0.0;
  const auto add = [&](const auto& a, const auto& b) {
    along += a.row(0).dot(b.row(0)) + a.row(1).dot(b.row(1));
    across += a.row(0).dot(b.row(1)) - a.row(1).dot(b.row(0));
  };
  add(shape.positions, other.positions);
  add(shape.directions, other.directions);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(std::atan2(across, along), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return {turn * shape.positions, turn * shape.directions};
}

double distance(const Shape& a, const Shape& b, double limit) {
  constexpr int kCells = 2 * kBand + 1;  // per row: b from a - kBand to a + kBand
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double sum_limit = limit * Shape::kPoints;
  std::array<double, kCells + 2> row;  // with a border on both sides
  row.fill(kInfinity);
  for (int i = 0; i < Shape::kPoints; ++i) {
    // In the previous row, index k belongs to b - 1.
    const std::array<double, kCells + 2> before = row;
    row.fill(kInfinity);
    double least = kInfinity;
    for (int k = 1; k <= kCells; ++k) {
      const int j = i + k - 1 - kBand;
      if (j < 0 || j >= Shape::kPoints)
        continue;
      const double best = i == 0 && j == 0 ? 0.0 : std::min({before[k], before[k + 1], row[k - 1]});
      row[k] = best + (a.positions.col(i) - b.positions.col(j)).squaredNorm() +
               (a.directions.col(i) - b.directions.col(j)).squaredNorm();
      least = std::min(least, row[k]);
    }
    if (least > sum_limit)
      return kInfinity;
  }
  const double sum = row[1 + kBand];
  return sum > sum_limit ? kInfinity : sum / Shape::kPoints;
}

}  // namespace wiimote_tracker::gesture
