#include "rooms/walker.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::rooms {

namespace {

// Deviations of a walker's velocity and position, per axis: standard deviations [m/s, m] and
// autocorrelation times [s].
constexpr double kWander = 0.04;
constexpr double kWanderTime = 1.0;
constexpr double kSway = 0.02;
constexpr double kSwayTime = 0.5;

/// Correlation exp(-|s - t| / decay) integrated over s from 0 to a and t from 0 to b [s^2].
double integratedTwice(double a, double b, double decay) {
  const auto left = [decay](double time) { return std::exp(-std::abs(time) / decay); };
  if (a * b < 0.0)
    return -decay * decay * (1.0 - left(a)) * (1.0 - left(b));
  return 2.0 * decay * std::min(std::abs(a), std::abs(b)) +
         decay * decay * (left(a) + left(b) - left(a - b) - 1.0);
}

/// Covariance of the positions of one axis about the line that they had at `time`.
Eigen::MatrixXd covarianceOf(const Path& path, double time) {
  const auto size = static_cast<Eigen::Index>(path.size());
  Eigen::MatrixXd covariance(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const PathPoint& a = path[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < size; ++j) {
      const PathPoint& b = path[static_cast<std::size_t>(j)];
      covariance(i, j) =
          kWander * kWander * integratedTwice(a.time - time, b.time - time, kWanderTime) +
          kSway * kSway * std::exp(-std::abs(a.time - b.time) / kSwayTime);
    }
    covariance(i, i) += a.variance;
  }
  return covariance;
}

/// Derivative of the positions by that at `time` and the velocity.
Eigen::MatrixX2d lineDesign(const Path& path, double time) {
  Eigen::MatrixX2d design(path.size(), 2);
  for (std::size_t i = 0; i < path.size(); ++i)
    design.row(static_cast<Eigen::Index>(i)) << 1.0, path[i].time - time;
  return design;
}

/// Straight line at constant velocity through a path, by generalised least squares:
/// (position at `time`, velocity) = weights * positions, in each axis.
Eigen::Matrix<double, 2, Eigen::Dynamic> lineWeights(const Path& path, double time) {
  const Eigen::MatrixX2d design = lineDesign(path, time);
  const Eigen::MatrixX2d weighed = covarianceOf(path, time).ldlt().solve(design);
  const Eigen::Matrix2d information = design.transpose() * weighed;
  return information.inverse() * weighed.transpose();
}

}  // namespace

Eigen::MatrixX3d positionsOf(const Path& path) {
  Eigen::MatrixX3d positions(path.size(), 3);
  for (std::size_t i = 0; i < path.size(); ++i)
    positions.row(static_cast<Eigen::Index>(i)) = path[i].position.transpose();
  return positions;
}

Eigen::Vector3d velocityOf(const Path& path) {
  return (lineWeights(path, path.front().time) * positionsOf(path)).row(1).transpose();
}

double crookednessOf(const Path& path) {
  const double time = path.front().time;
  const Eigen::MatrixXd line = lineDesign(path, time) * lineWeights(path, time);
  const Eigen::MatrixXd residual = Eigen::MatrixXd::Identity(line.rows(), line.cols()) - line;
  const double expected = (residual * covarianceOf(path, time) * residual.transpose()).trace();
  return std::sqrt((residual * positionsOf(path)).squaredNorm() / (3.0 * expected));
}

std::array<HiddenPlace, 2> hiddenPlaces(const Path& before, const Path& after) {
  const double middle = 0.5 * (before.back().time + after.front().time);
  Path all = before;
  all.insert(all.end(), after.begin(), after.end());
  const auto first = static_cast<Eigen::Index>(before.size());
  const auto second = static_cast<Eigen::Index>(after.size());
  // Of the line before and of that after: position at the middle time, velocity.
  Eigen::MatrixX4d design = Eigen::MatrixX4d::Zero(all.size(), 4);
  design.topLeftCorner(first, 2) = lineDesign(before, middle);
  design.bottomRightCorner(second, 2) = lineDesign(after, middle);
  const Eigen::MatrixX4d weighed = covarianceOf(all, middle).ldlt().solve(design);
  const Eigen::Matrix4d lines = (design.transpose() * weighed).inverse();
  Eigen::Matrix<double, 2, 4> later_less_earlier;
  later_less_earlier << -Eigen::Matrix2d::Identity(), Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d covariance = later_less_earlier * lines * later_less_earlier.transpose();
  const Eigen::Matrix<double, 2, Eigen::Dynamic> difference =
      later_less_earlier * lines * weighed.transpose();
  // With c11 for the velocity's, the variance of the difference at a time t is variance + c11 (t -
  // shift)^2. Those at shift -+ distance have the covariance variance - c11 distance^2 = 0.
  const double shift = -covariance(0, 1) / covariance(1, 1);
  const double variance = covariance(0, 0) + shift * covariance(0, 1);
  const double distance = std::sqrt(variance / covariance(1, 1));
  const auto placeAt = [&](double time) {
    const Eigen::RowVector2d at(1.0, time);
    return HiddenPlace{-at * difference.leftCols(first), at * difference.rightCols(second),
                       std::sqrt(2.0 * variance)};
  };
  return {placeAt(shift - distance), placeAt(shift + distance)};
}

}  // namespace wiimote_tracker::rooms
