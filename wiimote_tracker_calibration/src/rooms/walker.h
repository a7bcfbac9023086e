#pragma once

#include <Eigen/Core>

#include <array>
#include <vector>

/// How somebody walks who carries an LED straight through a door: at constant velocity, with
/// deviations in each axis that are the sum of two first-order Gauss-Markov processes: in the
/// velocity (heading, speed) and in the position (steps, sway of the hand).
namespace wiimote_tracker::rooms {

/// A point of an LED's track, in the world of its rig.
struct PathPoint {
  double time;  ///< [s]
  Eigen::Vector3d position;
  double variance;  ///< Of the position, per axis [m^2].
};

using Path = std::vector<PathPoint>;

/// Positions of a path's points, one in each row [m].
Eigen::MatrixX3d positionsOf(const Path& path);

/// Velocity of the straight line through a path, by generalised least squares [m/s].
/// @param path at least two points at different times
Eigen::Vector3d velocityOf(const Path& path);

/// RMS distance of a path from its line over what the deviations explain [1].
double crookednessOf(const Path& path);

/// A place where the LED was while it was hidden, or nearly so, as the line on either side of the
/// door has it. Both lines are estimated together, since deviations last longer than the door
/// hides.
struct HiddenPlace {
  Eigen::RowVectorXd before_weights;  ///< Times the positions before: the place by that line.
  Eigen::RowVectorXd after_weights;   ///< The same of those after.
  double stddev;                      ///< Of the one against the other, per axis [m].
};

/// Two places whose errors are independent. They say as much as the two lines' positions and
/// velocities.
std::array<HiddenPlace, 2> hiddenPlaces(const Path& before, const Path& after);

}  // namespace wiimote_tracker::rooms
