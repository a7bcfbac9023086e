#pragma once

#include "wiimote_tracker_triangulation/body/pose_state.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>

namespace wiimote_tracker::body {

/// A mode of motion: white noise accelerates the body.
struct PoseMode {
  double acceleration_density;          ///< [m/s^2 / sqrt(Hz), >= 0]
  double angular_acceleration_density;  ///< [rad/s^2 / sqrt(Hz), >= 0]
};

enum PoseModeIndex { kCalm, kAgile };
constexpr int kPoseModes = 2;

struct PoseFilterOptions {
  /// kCalm: held or carried with care; kAgile: any other motion.
  std::array<PoseMode, kPoseModes> modes{{{0.2, 0.6}, {0.7, 7.0}}};

  double change_rate = 0.3;  ///< Transition rate between the modes, both ways [1/s, > 0].

  double initial_speed = 2.0;          ///< Initial standard deviation per axis [m/s, > 0].
  double initial_angular_speed = 6.0;  ///< Initial standard deviation per axis [rad/s, > 0].
};

/// A rigid body's pose, velocity and angular velocity in continuous time; each camera's spots
/// update it at the time of their image. An interacting multiple model filter (Blom and Bar-Shalom
/// 1988; Bar-Shalom, Li and Kirubarajan 2001, section 11.6.6) of extended Kalman filters, one for
/// each of PoseFilterOptions::modes. A value type; never allocates.
class PoseFilter {
 public:
  /// @param options not owned. @param covariance position [m^2], then rotation about the world axes
  /// [rad^2].
  PoseFilter(const PoseFilterOptions& options,
             double time,
             const Eigen::Isometry3d& world_from_body,
             const PoseCovariance& covariance);

  /// All modes start equally likely.
  PoseFilter(const PoseFilterOptions& options, double time, const PoseState& start);

  double time() const { return time_; }  ///< [s]

  /// Predicts to a time [s]; does nothing unless it is after time().
  void predict(double time);

  /// Updates with the pixel of an LED's spot at time(). The prediction must stem from the present
  /// state: every update changes it.
  void update(const LedPrediction& prediction, const Eigen::Vector2d& pixel);

  /// Mean and covariance of the mixture of all modes.
  const PoseState& state() const { return mean_; }

 private:
  using Weights = Eigen::Matrix<double, kPoseModes, 1>;

  PoseState mixture(const Weights& weights) const;
  void mix(double duration);

  const PoseFilterOptions* options_;
  double time_;
  Weights probabilities_;
  std::array<PoseState, kPoseModes> states_;  // of the body if it is in that mode
  PoseState mean_;
};

}  // namespace wiimote_tracker::body
