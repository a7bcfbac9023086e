#include "rooms/walk.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <cmath>

namespace wiimote_tracker::rooms {

namespace {

/// Covariance of the positions of one axis about the line.
Eigen::MatrixXd covarianceOf(const Path& path, const WalkModel& model) {
  const auto size = static_cast<Eigen::Index>(path.size());
  Eigen::MatrixXd covariance(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const PathPoint& a = path[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < size; ++j) {
      const double apart = std::abs(a.time - path[static_cast<std::size_t>(j)].time);
      covariance(i, j) =
          model.deviation * model.deviation * std::exp(-apart / model.deviation_time);
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

}  // namespace

Eigen::MatrixX3d positionsOf(const Path& path) {
  Eigen::MatrixX3d positions(path.size(), 3);
  for (std::size_t i = 0; i < path.size(); ++i)
    positions.row(static_cast<Eigen::Index>(i)) = path[i].position.transpose();
  return positions;
}

Eigen::Matrix<double, 2, Eigen::Dynamic> lineWeights(const Path& path,
                                                     double time,
                                                     const WalkModel& model) {
  const Eigen::MatrixX2d design = lineDesign(path, time);
  const Eigen::MatrixX2d weighed = covarianceOf(path, model).ldlt().solve(design);
  const Eigen::Matrix2d information = design.transpose() * weighed;
  return information.inverse() * weighed.transpose();
}

Eigen::Vector3d velocityOf(const Path& path, const WalkModel& model) {
  return (lineWeights(path, path.front().time, model) * positionsOf(path)).row(1).transpose();
}

double crookednessOf(const Path& path, const WalkModel& model) {
  const double time = path.front().time;
  const Eigen::MatrixXd line = lineDesign(path, time) * lineWeights(path, time, model);
  const Eigen::MatrixXd residual = Eigen::MatrixXd::Identity(line.rows(), line.cols()) - line;
  const double expected = (residual * covarianceOf(path, model) * residual.transpose()).trace();
  return std::sqrt((residual * positionsOf(path)).squaredNorm() / (3.0 * expected));
}

std::array<HiddenPlace, 2> hiddenPlaces(const Path& before,
                                        const Path& after,
                                        const WalkModel& model) {
  const double middle = 0.5 * (before.back().time + after.front().time);
  const auto before_line = lineWeights(before, middle, model);
  const auto after_line = lineWeights(after, middle, model);
  Path all = before;
  all.insert(all.end(), after.begin(), after.end());
  Eigen::Matrix<double, 2, Eigen::Dynamic> difference(2, all.size());
  difference << -before_line, after_line;
  // Of the difference of both lines: position at the middle time, velocity.
  const Eigen::Matrix2d covariance = difference * covarianceOf(all, model) * difference.transpose();
  // The position's error is independent of the velocity's at one time, and those at equal distances
  // before and after it of each other where the distance is the ratio of both.
  const double shift = -covariance(0, 1) / covariance(1, 1);
  const double variance = covariance(0, 0) + shift * covariance(0, 1);
  const double distance = std::sqrt(variance / covariance(1, 1));
  const auto placeAt = [&](double time) {
    const Eigen::RowVector2d at(1.0, time);
    return HiddenPlace{at * before_line, at * after_line, std::sqrt(2.0 * variance)};
  };
  return {placeAt(shift - distance), placeAt(shift + distance)};
}

}  // namespace wiimote_tracker::rooms
