#pragma once

#include "wiimote_tracker_triangulation/geometry/camera.h"
#include "wiimote_tracker_triangulation/motion/motion_options.h"

#include <Eigen/Core>

#include <vector>

namespace wiimote_tracker::motion::test {

/// A linear system with white noise in continuous time, dx = A x dt + noise of a density, over a
/// duration: Van Loan's method (1978), by the exponential of a matrix.
struct Transition {
  Transition(const Eigen::MatrixXd& A, const Eigen::MatrixXd& density, double duration);

  /// The same in three axes: all positions, then all velocities, then all accelerations.
  Transition inThreeAxes() const;

  Eigen::MatrixXd F, Q;
};

/// A Singer model of one axis: position, velocity, acceleration.
Transition singerTransition(double stddev, double time, double duration);

/// The interacting multiple model filter as the textbook has it (Bar-Shalom, Li, Kirubarajan 2001,
/// section 11.6.6; but mixed after the prediction) over the modes of MotionOptions, with dynamic
/// matrices of nine rows and Van Loan's method instead of closed forms. Linearised at the mean of
/// the mixture, once.
class TextbookImm {
 public:
  struct Model {
    double probability;
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
  };

  TextbookImm(const MotionOptions& options,
              double time,
              const Eigen::Vector3d& position,
              const Eigen::Matrix3d& covariance);

  void predict(double time);

  /// Mixing by the stops over a duration [s].
  void stop(double duration);

  /// Mixing by all other mode changes over a duration [s].
  void change(double duration);

  void update(const geometry::Camera& camera, const Eigen::Vector2d& pixel, double pixel_stddev);

  /// Density of a pixel [1/px^2].
  double density(const geometry::Camera& camera,
                 const Eigen::Vector2d& pixel,
                 double pixel_stddev) const;

  Eigen::VectorXd mean() const;
  Eigen::MatrixXd covariance() const;
  /// Those at rest and the moving ones of MotionOptions, then the sudden one.
  const std::vector<Model>& models() const { return models_; }

 private:
  /// @param rates from row to column [1/s]
  void interact(const Eigen::MatrixXd& rates, double duration);

  MotionOptions options_;
  double time_;
  std::vector<Model> models_;
};

}  // namespace wiimote_tracker::motion::test
