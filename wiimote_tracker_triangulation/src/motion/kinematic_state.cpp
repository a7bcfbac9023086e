#include "motion/kinematic_state.h"

namespace wiimote_tracker::motion {
namespace {

/// m becomes m (F (x) I)^T. Each block of columns needs itself and those to its right, since F is
/// upper triangular.
template <typename Matrix>
void timesTransposed(const Eigen::Matrix3d& F, Matrix&& m) {
  for (int i = 0; i < 3; ++i) {
    m.template middleCols<3>(3 * i) *= F(i, i);
    for (int j = i + 1; j < 3; ++j)
      m.template middleCols<3>(3 * i) += F(i, j) * m.template middleCols<3>(3 * j);
  }
}

}  // namespace

void KinematicState::predict(const Transition& transition) {
  timesTransposed(transition.F, mean.transpose());
  // F P F^T = ((P F^T)^T) F^T. Rounding must not make it asymmetric, so one half is copied.
  timesTransposed(transition.F, covariance);
  covariance.transposeInPlace();
  timesTransposed(transition.F, covariance);
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j)
      covariance.block<3, 3>(3 * i, 3 * j).diagonal().array() += transition.Q(i, j);
  }
  covariance.triangularView<Eigen::StrictlyLower>() = covariance.transpose();
}

void KinematicState::decay(const Eigen::Vector3d& direction,
                           double kept,
                           double velocity_variance,
                           double acceleration_variance) {
  const Eigen::Matrix3d along = direction * direction.transpose();
  const Eigen::Matrix3d M = Eigen::Matrix3d::Identity() - (1.0 - kept) * along;
  const double added = 1.0 - kept * kept;
  for (const int i : {3, 6}) {
    mean.segment<3>(i) = (M * mean.segment<3>(i)).eval();
    covariance.middleCols<3>(i) = (covariance.middleCols<3>(i) * M).eval();
    covariance.middleRows<3>(i) = (M * covariance.middleRows<3>(i)).eval();
  }
  covariance.block<3, 3>(3, 3) += added * velocity_variance * along;
  covariance.block<3, 3>(6, 6) += added * acceleration_variance * along;
}

}  // namespace wiimote_tracker::motion
