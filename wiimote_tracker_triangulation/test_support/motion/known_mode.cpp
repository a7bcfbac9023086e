#include "motion/known_mode.h"

#include "geometry/gaussian.h"

#include <Eigen/LU>

namespace wiimote_tracker::motion::test {
SingerTruth::SingerTruth(double stddev, double time, double step) : stddev_(stddev) {
  const Transition transition = singerTransition(stddev, time, step);
  F_ = transition.F;
  noise_ = geometry::test::rootOf(transition.Q);
}

void SingerTruth::place(const Eigen::Vector3d& position, const Eigen::Vector3d& velocity) {
  state_.setZero();
  state_.col(0) = position;
  state_.col(1) = velocity;
}

void SingerTruth::startMoving(geometry::test::Random& random) {
  moves_ = true;
  for (int i = 0; i < 3; ++i)
    state_(i, 2) = stddev_ * random.gaussian();
}

void SingerTruth::stop() {
  moves_ = false;
  state_.rightCols<2>().setZero();
}

void SingerTruth::step(geometry::test::Random& random) {
  if (!moves_)
    return;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d before = state_.row(axis);
    Eigen::Vector3d noise;
    for (int i = 0; i < 3; ++i)
      noise[i] = random.gaussian();
    state_.row(axis) = (F_ * before + noise_ * noise).transpose();
  }
}

KnownModeBound::KnownModeBound(double stddev,
                               double time,
                               double step,
                               const Eigen::Matrix3d& position_covariance,
                               double speed_stddev)
    : transition_(singerTransition(stddev, time, step).inThreeAxes()), stddev_(stddev) {
  P_ = Eigen::MatrixXd::Zero(9, 9);
  P_.topLeftCorner<3, 3>() = position_covariance;
  P_.block<3, 3>(3, 3).diagonal().setConstant(speed_stddev * speed_stddev);
  P_.bottomRightCorner<3, 3>().diagonal().setConstant(stddev * stddev);
}

void KnownModeBound::startMoving() {
  moves_ = true;
  P_.bottomRightCorner<3, 3>().diagonal().setConstant(stddev_ * stddev_);
}

void KnownModeBound::stop() {
  moves_ = false;
  P_.rightCols(6).setZero();
  P_.bottomRows(6).setZero();
}

void KnownModeBound::step() {
  if (moves_)
    P_ = (transition_.F * P_ * transition_.F.transpose() + transition_.Q).eval();
}

void KnownModeBound::observe(const geometry::Camera& camera,
                             const Eigen::Vector3d& truth,
                             double pixel_stddev) {
  Eigen::Matrix<double, 2, 3> H;
  if (!camera.project(truth, &H))
    return;
  const Eigen::MatrixXd gain = P_.leftCols(3) * H.transpose();
  const Eigen::Matrix2d S =
      H * gain.topRows(3) + pixel_stddev * pixel_stddev * Eigen::Matrix2d::Identity();
  P_ -= (gain * S.inverse() * gain.transpose()).eval();
  P_ = (0.5 * (P_ + P_.transpose())).eval();  // else asymmetry from rounding grows
}

}  // namespace wiimote_tracker::motion::test
