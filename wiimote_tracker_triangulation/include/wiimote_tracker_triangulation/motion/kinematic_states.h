#ifndef WIIMOTE_TRACKER_TRIANGULATION_MOTION_KINEMATIC_STATES_H
#define WIIMOTE_TRACKER_TRIANGULATION_MOTION_KINEMATIC_STATES_H

#include "wiimote_tracker_triangulation/motion/innovations.h"

#include <Eigen/Core>

#include <array>

namespace wiimote_tracker::motion {

/// The transition of four states over a duration, alike in each axis: a linear one of position,
/// velocity and acceleration, plus noise.
///   p' = p + p_v v + p_a a,  v' = v + v_a a,  a' = a_a a
struct KinematicSteps {
  double p_v;                          ///< The duration [s].
  Lanes p_a, v_a, a_a;                 ///< [s^2], [s], [1]
  Lanes noise_pp, noise_pv, noise_pa;  ///< [m^2], [m^2/s], [m^2/s^2]
  Lanes noise_vv, noise_va, noise_aa;  ///< [m^2/s^2], [m^2/s^3], [m^2/s^4]
};

/// Four normal distributions of one LED's position, velocity and acceleration in the world [m, s],
/// of which one at most is right. All four take the same steps at once.
///
/// The covariance of the nine is kept by blocks: of the symmetric ones xx, xy, xz, yy, yz, zz; of
/// the others row by row (so pv[3 * i + j] is the covariance of p[i] and v[j]).
struct KinematicStates {
  std::array<Lanes, 3> p, v, a;
  std::array<Lanes, 6> pp, vv, aa;
  std::array<Lanes, 9> pv, pa, va;

  void setZero();
  void predict(const KinematicSteps& steps);

  /// Kalman update of each state with its own innovation.
  void update(const Innovations<Lanes>& innovations);

  /// Velocity and acceleration along a direction are forgotten in part: they become what they were
  /// times `kept`, plus noise, so that with nothing kept they have these variances.
  /// @param direction of length 1  @param kept [0..1]  @param speed_variance [m^2/s^2]
  /// @param acceleration_variances [m^2/s^4]
  void forget(const Eigen::Vector3d& direction,
              double kept,
              double speed_variance,
              const Lanes& acceleration_variances);

  /// Each state becomes what the mixture of the old ones has for mean and covariance.
  /// @param shares shares[i] holds old state i's share of each new state. @param rest_shares of a
  /// state at rest at `rest_position` with the covariance `rest_covariance`; with it, all shares of
  /// a new state add up to 1.
  void mix(const std::array<Lanes, 4>& shares,
           const Lanes& rest_shares,
           const Eigen::Vector3d& rest_position,
           const Eigen::Matrix3d& rest_covariance);

  Eigen::Vector3d position(int state) const { return {p[0][state], p[1][state], p[2][state]}; }
};

}  // namespace wiimote_tracker::motion

#endif  // WIIMOTE_TRACKER_TRIANGULATION_MOTION_KINEMATIC_STATES_H
