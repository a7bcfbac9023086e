#ifndef WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_CONSTANT_NOISE_FILTER_H
#define WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_CONSTANT_NOISE_FILTER_H

#include "motion/kinematic_state.h"
#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <Eigen/Core>

namespace wiimote_tracker {

/// An extended Kalman filter of one motion model, for comparison: the velocity (order 2) or the
/// acceleration (order 3) is a random walk.
class ConstantNoiseFilter {
 public:
  /// @param density of the random walk [m^2/s^3] or [m^2/s^5]
  ConstantNoiseFilter(int order,
                      double density,
                      double time,
                      const Eigen::Vector3d& position,
                      const Eigen::Matrix3d& covariance,
                      double pixel_stddev);

  void predict(double time);
  void update(const geometry::Camera& camera, const Eigen::Vector2d& pixel);
  Eigen::Vector3d position() const { return state_.position(); }

 private:
  int order_;
  double density_;
  double time_;
  double pixel_variance_;
  motion::KinematicState state_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_CONSTANT_NOISE_FILTER_H
