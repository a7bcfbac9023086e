#pragma once

#include <Eigen/Core>

namespace wiimote_tracker::motion {

/// How position, velocity and acceleration of one axis change over a duration: x' = F x + noise of
/// the covariance Q [m, s]. F is upper triangular.
struct Transition {
  Eigen::Matrix3d F, Q;
};

/// The acceleration a is a stationary first-order Markov process, da = -a / time dt + noise
/// (R. A. Singer, "Estimating optimal tracking filter performance for manned maneuvering targets",
/// IEEE Trans. AES 6(4), 1970).
/// @param stddev of the acceleration [m/s^2]  @param time its autocorrelation time [s, > 0]
/// @param duration [s, >= 0]
Transition singer(double stddev, double time, double duration);

/// The velocity is a random walk: white-noise acceleration (Bar-Shalom, Li and Kirubarajan 2001,
/// section 6.2.2). The acceleration becomes zero. @param density [m/s/sqrt(s)]
Transition randomWalkOfVelocity(double density, double duration);

}  // namespace wiimote_tracker::motion
