#pragma once

#include "geometry/random_rigs.h"

#include <Eigen/Core>

#include <functional>
#include <string>
#include <vector>

namespace wiimote_tracker::tracking::test {

/// Where an LED is [m] at a time [s].
using Path = std::function<Eigen::Vector3d(double)>;

Path still(const Eigen::Vector3d& position);

/// A circle about the vertical. @param speed [m/s] @param phase at time 0 [rad]
Path circle(const Eigen::Vector3d& center, double radius, double speed, double phase = 0.0);

/// Through `point` at time `when`, with a steady velocity [m/s].
Path straight(const Eigen::Vector3d& point, const Eigen::Vector3d& velocity, double when = 0.0);

/// A smooth random wandering inside a box, as a hand's: six sine waves of 0.1 to 1.2 Hz per axis,
/// of the same share of the velocity's variance each. @param speed RMS [m/s], less where the box is
/// so small that it turns back at its walls.
Path wandering(geometry::test::Random& random,
               const Eigen::Vector3d& center,
               double half_side,
               double speed);

/// Up to four LEDs, each wandering in its own quarter of the paper's cube, at least 0.4 m from the
/// others. @param speed RMS [m/s]
std::vector<Path> wanderers(int count, unsigned seed, double speed = 1.0);

/// Random motion of this RMS speed [m/s, > 0] and RMS acceleration [m/s^2, > 0]: five sine waves
/// per axis, within a factor of 4 in frequency.
Path shaken(geometry::test::Random& random,
            const Eigen::Vector3d& center,
            double speed,
            double acceleration);

/// Linearly interpolated between samples `interval` [s] apart, and again from the start at the end.
Path sampled(const std::vector<Eigen::Vector3d>& samples, double interval);

/// Three columns of a CSV file [mm], from `column` (0: the first), as metres; lines that do not
/// begin with a number are left out. @throws std::runtime_error: missing, no samples.
std::vector<Eigen::Vector3d> readMotion(const std::string& file, int column);

}  // namespace wiimote_tracker::tracking::test
