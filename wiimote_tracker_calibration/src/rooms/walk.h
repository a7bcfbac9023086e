#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_ROOMS_WALK_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_ROOMS_WALK_H

#include <Eigen/Core>

#include <array>
#include <vector>

namespace wiimote_tracker::rooms {

/// How somebody walks who carries an LED straight through a door: at constant velocity, with
/// deviations in each axis (steps, sway of the hand, speed) that are a first-order Gauss-Markov
/// process.
struct WalkModel {
  double deviation = 0.04;      ///< Standard deviation, per axis [m, > 0].
  double deviation_time = 0.7;  ///< Autocorrelation time of the deviations [s, > 0].
};

/// A point of an LED's track, in the world of its rig.
struct PathPoint {
  double time;  ///< [s]
  Eigen::Vector3d position;
  double variance;  ///< Of the position, per axis [m^2].
};

using Path = std::vector<PathPoint>;

/// Straight line at constant velocity through a path, by generalised least squares:
/// (position at `time`, velocity) = weights * positions, in each axis.
/// @param path at least two points at different times
Eigen::Matrix<double, 2, Eigen::Dynamic> lineWeights(const Path& path,
                                                     double time,
                                                     const WalkModel& model);

/// Positions of a path's points, one in each row [m].
Eigen::MatrixX3d positionsOf(const Path& path);

/// Velocity of the line [m/s].
Eigen::Vector3d velocityOf(const Path& path, const WalkModel& model);

/// RMS distance of a path from its line over that of the model [1].
double crookednessOf(const Path& path, const WalkModel& model);

/// A place where the LED was while it was hidden, or nearly so, as the line on either side of the
/// door has it.
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
