#pragma once

#include "geometry/random_rigs.h"
#include "motion/textbook_imm.h"
#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <Eigen/Core>

namespace wiimote_tracker::motion::test {

/// An LED that is still, or moves by a Singer model; it starts from rest with an acceleration of
/// that model, and stops at once. Drawn at equal steps.
class SingerTruth {
 public:
  SingerTruth(double stddev, double time, double step);

  void place(const Eigen::Vector3d& position, const Eigen::Vector3d& velocity);
  void startMoving(geometry::test::Random& random);  ///< Draws the acceleration.
  void stop();
  void step(geometry::test::Random& random);

  bool moves() const { return moves_; }
  Eigen::Vector3d position() const { return state_.col(0); }
  Eigen::Vector3d velocity() const { return state_.col(1); }

 private:
  Eigen::Matrix3d F_, noise_;  // of one axis; Cholesky factor
  double stddev_;
  bool moves_ = false;
  Eigen::Matrix3d state_ = Eigen::Matrix3d::Zero();  // columns: position, velocity, acceleration
};

/// Posterior Cramer-Rao bound of the position of a SingerTruth, for an observer that knows when it
/// moves: the recursion of Tichavsky, Muravchik and Nehorai (IEEE Trans. SP 46(5), 1998), as a
/// covariance, with the pixels' derivatives at the truth.
class KnownModeBound {
 public:
  KnownModeBound(double stddev,
                 double time,
                 double step,
                 const Eigen::Matrix3d& position_covariance,
                 double speed_stddev);

  void startMoving();
  void stop();
  void step();
  void observe(const geometry::Camera& camera, const Eigen::Vector3d& truth, double pixel_stddev);

  /// Least mean squared error of the position [m^2].
  double squaredError() const { return P_.topLeftCorner<3, 3>().trace(); }

 private:
  Transition transition_;
  double stddev_;
  bool moves_ = true;
  Eigen::MatrixXd P_;
};

}  // namespace wiimote_tracker::motion::test
