#ifndef WIIMOTE_TRACKER_TRIANGULATION_MOTION_RESTING_STATES_H
#define WIIMOTE_TRACKER_TRIANGULATION_MOTION_RESTING_STATES_H

#include "wiimote_tracker_triangulation/motion/innovations.h"

#include <Eigen/Core>

#include <array>

namespace wiimote_tracker::motion {

/// Two normal distributions of one LED's position in the world [m] while it rests, of which one at
/// most is right. The covariances are kept as xx, xy, xz, yy, yz, zz.
struct RestingStates {
  std::array<Pair, 3> p;
  std::array<Pair, 6> pp;

  /// Both alike.
  void set(const Eigen::Vector3d& position, const Eigen::Matrix3d& covariance);

  /// @param variances that the walk adds in each axis [m^2]
  void predict(const Pair& variances);

  /// Kalman update of each state with its own innovation.
  void update(const Innovations<Pair>& innovations);

  /// Each state becomes what the mixture of it and of another distribution has for mean and
  /// covariance. @param shares of the other in each mixture [0..1]
  void join(const Pair& shares, const Eigen::Vector3d& mean, const Eigen::Matrix3d& covariance);
};

}  // namespace wiimote_tracker::motion

#endif  // WIIMOTE_TRACKER_TRIANGULATION_MOTION_RESTING_STATES_H
