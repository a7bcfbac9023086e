#ifndef WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_CONSTANT_NOISE_FILTER_H
#define WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_CONSTANT_NOISE_FILTER_H

#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <Eigen/Core>

namespace wiimote_tracker {

/// The extended Kalman filter of every textbook, for comparison: the velocity (order 2) or the
/// acceleration (order 3) is a random walk of one density for ever.
class ConstantNoiseFilter {
 public:
  /// @param density [m^2/s^3] or [m^2/s^5]
  ConstantNoiseFilter(int order,
                      double density,
                      double time,
                      const Eigen::Vector3d& position,
                      const Eigen::Matrix3d& covariance,
                      double pixel_stddev);

  void predict(double time);
  void update(const geometry::Camera& camera, const Eigen::Vector2d& pixel);
  Eigen::Vector3d position() const { return x_.head<3>(); }

 private:
  int order_;
  double density_;
  double time_;
  double pixel_variance_;
  Eigen::VectorXd x_;  // position, velocity, and with order 3 acceleration
  Eigen::MatrixXd P_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_CONSTANT_NOISE_FILTER_H
