// A solver of its own: the weights turn with the motion that is estimated, and the covariance of
// the joined rig needs the gain of every error, which the loop below has at hand. Six unknowns, and
// two, three or ten conditions for each thing shared, are solved in closed form a few times.
#include "rooms/rig_motion.h"

#include "adjust/chi_squared.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <Eigen/Geometry>

#include <limits>

namespace wiimote_tracker::rooms {

namespace {

namespace so3 = geometry::so3;

// Smallest standard deviation [rad, m]: keeps covariances invertible if a parameter was held.
constexpr double kLeastStddev = 1e-5;
// Conditions of what is shared, which tell its kind.
constexpr Eigen::Index kVertical = 2;
constexpr Eigen::Index kPlace = 3;
constexpr Eigen::Index kCamera = 10;
// What one lens may differ by from one calibration to the other, beside their covariances, since it
// warms up and no model is exact [px].
constexpr double kLensStddev = 0.5;

/// Linearised conditions: residual + by_motion * m + by_errors * e = 0, with the errors m of the
/// motion and e, both as RigMotion counts them.
struct Conditions {
  Eigen::VectorXd residual;
  Eigen::MatrixXd by_motion;
  Eigen::MatrixXd by_errors;
};

Eigen::Index conditionCount(const std::vector<Shared>& shared) {
  Eigen::Index count = 0;
  for (const Shared& one : shared)
    count += one.by_second.rows();
  return count;
}

Conditions conditionsAt(const Eigen::Isometry3d& motion, const std::vector<Shared>& shared) {
  const Eigen::Index count = conditionCount(shared);
  const Eigen::Index first_size = shared.front().by_first.cols();
  const Eigen::Index second_size = shared.front().by_second.cols();
  Conditions result{Eigen::VectorXd(count), Eigen::MatrixXd::Zero(count, 6),
                    Eigen::MatrixXd(count, first_size + second_size + count)};
  result.by_errors.rightCols(count).setIdentity();
  Eigen::Index row = 0;
  for (const Shared& one : shared) {
    const Eigen::Index rows = one.by_second.rows();
    auto residual = result.residual.segment(row, rows);
    auto by_motion = result.by_motion.middleRows(row, rows);
    auto by_second = result.by_errors.block(row, first_size, rows, second_size);
    result.by_errors.block(row, 0, rows, first_size) = -one.by_first;
    const Eigen::Isometry3d moved = motion * one.in_second;
    if (rows == kVertical) {
      const Eigen::Matrix<double, 2, 3> level = one.in_first.linear().leftCols<2>().transpose();
      const Eigen::Vector3d up = moved.linear().col(2);
      residual = level * up;
      by_motion.leftCols<3>() = -level * so3::skew(up);
      by_second = one.by_second;
    } else {
      const Eigen::Index position = rows == kCamera ? 3 : 0;
      if (rows == kCamera) {
        residual.head<3>() = so3::log(moved.linear() * one.in_first.linear().transpose());
        residual.tail<4>() = one.lens_difference;
        by_motion.topLeftCorner<3, 3>().setIdentity();
        by_second.bottomRows<4>() = one.by_second.bottomRows<4>();
      }
      residual.segment<3>(position) = moved.translation() - one.in_first.translation();
      by_motion.block<3, 3>(position, 0) =
          -so3::skew(motion.linear() * one.in_second.translation());
      by_motion.block<3, 3>(position, 3).setIdentity();
      for (Eigen::Index k = 0; k <= position; k += 3)
        by_second.middleRows<3>(k) = motion.linear() * one.by_second.middleRows<3>(k);
    }
    row += rows;
  }
  return result;
}

Eigen::MatrixXd errorCovariance(const geometry::Rig& first,
                                const geometry::Rig& second,
                                const std::vector<Shared>& shared) {
  const Eigen::Index first_size = first.covariance.rows();
  const Eigen::Index second_size = second.covariance.rows();
  const Eigen::Index count = conditionCount(shared);
  const Eigen::Index size = first_size + second_size + count;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
  covariance.topLeftCorner(first_size, first_size) = first.covariance;
  covariance.block(first_size, first_size, second_size, second_size) = second.covariance;
  Eigen::Index row = first_size + second_size;
  Eigen::VectorXd common = Eigen::VectorXd::Zero(size);
  for (const Shared& one : shared) {
    const Eigen::Index rows = one.by_second.rows();
    if (rows == kCamera) {
      covariance.diagonal().segment<4>(row + 6).setConstant(kLensStddev * kLensStddev);
    } else {
      const Eigen::Matrix3d axes =
          rows == kPlace ? one.in_first.linear() : Eigen::Matrix3d::Identity().eval();
      const Eigen::Matrix3d own = axes * one.stddevs.cwiseAbs2().asDiagonal() * axes.transpose();
      covariance.block(row, row, rows, rows) = own.topLeftCorner(rows, rows);
      if (rows == kPlace)
        common.segment<3>(row) = one.common;
    }
    row += rows;
  }
  covariance.diagonal().tail(count).array() += kLeastStddev * kLeastStddev;
  covariance += common * common.transpose();
  return covariance;
}

}  // namespace

bool RigMotion::contradicts() const {
  return degrees_of_freedom > 0 &&
         chi_squared > adjust::chiSquaredQuantile(degrees_of_freedom, adjust::kThreeNines);
}

RigMotion fitMotion(const geometry::Rig& first,
                    const geometry::Rig& second,
                    const std::vector<Shared>& shared,
                    const Eigen::Isometry3d& start) {
  RigMotion motion;
  motion.first_from_second = start;
  motion.error_covariance = errorCovariance(first, second, shared);
  const Eigen::Index first_size = first.covariance.rows();
  const Eigen::Index second_size = second.covariance.rows();
  // What the errors contribute is the same for each motion, but for those of the second rig.
  Eigen::MatrixXd by_fixed = conditionsAt(start, shared).by_errors;
  by_fixed.middleCols(first_size, second_size).setZero();
  const Eigen::MatrixXd fixed = geometry::propagated(by_fixed, motion.error_covariance);
  for (int iteration = 0;; ++iteration) {
    const Conditions conditions = conditionsAt(motion.first_from_second, shared);
    const Eigen::MatrixXd covariance =
        fixed + geometry::propagated(conditions.by_errors.middleCols(first_size, second_size),
                                     second.covariance);
    const Eigen::MatrixXd weighed = geometry::solveSymmetric(covariance, conditions.by_motion);
    const Eigen::MatrixXd gain =
        -geometry::solveSymmetric(conditions.by_motion.transpose() * weighed, weighed.transpose());
    motion.by_errors = gain * conditions.by_errors;
    motion.chi_squared = geometry::squaredMahalanobis(conditions.residual, covariance);
    motion.degrees_of_freedom = static_cast<int>(conditions.residual.size()) - 6;
    const Eigen::Matrix<double, 6, 1> step = gain * conditions.residual;
    if (!step.allFinite())
      throw Error("what the rigs share does not determine the pose between them: share more");
    if (step.norm() < 1e-10 || iteration == 20)
      return motion;
    motion.first_from_second.linear() =
        Eigen::Quaterniond(so3::exp(step.head<3>()) * motion.first_from_second.linear())
            .normalized()
            .toRotationMatrix();
    motion.first_from_second.translation() += step.tail<3>();
  }
}

std::size_t oddOneOut(const geometry::Rig& first,
                      const geometry::Rig& second,
                      const std::vector<Shared>& shared,
                      const Eigen::Isometry3d& start) {
  std::size_t odd = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < shared.size(); ++i) {
    std::vector<Shared> others = shared;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const double without = fitMotion(first, second, others, start).chi_squared;
    if (without < least) {
      least = without;
      odd = i;
    }
  }
  return odd;
}

}  // namespace wiimote_tracker::rooms
