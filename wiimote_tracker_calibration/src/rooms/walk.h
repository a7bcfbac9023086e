#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_ROOMS_WALK_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_ROOMS_WALK_H

#include <Eigen/Core>

#include <array>
#include <vector>

namespace wiimote_tracker::rooms {

/// How somebody walks who carries an LED straight through a door: at constant velocity, with
/// deviations in each axis that are the sum of two first-order Gauss-Markov processes: in the
/// velocity (heading, speed) and in the position (steps, sway of the hand).
struct WalkModel {
  double wander = 0.04;      ///< Standard deviation of the velocity, per axis [m/s, > 0].
  double wander_time = 1.0;  ///< Autocorrelation time of the velocity [s, > 0].
  double sway = 0.02;        ///< Standard deviation of the position, per axis [m, > 0].
  double sway_time = 0.5;    ///< Autocorrelation time of the position [s, > 0].
  /// Standard deviation of the share by which a walker is slower, or faster, while the LED is
  /// hidden, in all passages alike [1, >= 0]. Assumed: people slow down the more, the narrower the
  /// opening (K. Wilmut and A. L. Barnett, "Locomotor adjustments when navigating through
  /// apertures", Hum. Mov. Sci. 29(2), 2010).
  double slowing = 0.03;
};

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
Eigen::Vector3d velocityOf(const Path& path, const WalkModel& model);

/// RMS distance of a path from its line over that of the model [1].
double crookednessOf(const Path& path, const WalkModel& model);

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
std::array<HiddenPlace, 2> hiddenPlaces(const Path& before,
                                        const Path& after,
                                        const WalkModel& model);

}  // namespace wiimote_tracker::rooms

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_ROOMS_WALK_H
