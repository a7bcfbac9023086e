#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <random>
#include <vector>

// Positions of the LED in the paper (section V.B) [m]. z points up here, but into the floor in the
// paper: its point (x, y, -h) is (x, y, h) here.
namespace wiimote_tracker::monte_carlo {

constexpr double kSide = 2.5;  // of the square and of the cube over it
constexpr double kCircleRadius = 0.75;
constexpr double kFloorPlacement = 0.01;  // greatest placement error on the floor
constexpr double kAirPlacement = 0.03;    // and above it

/// The corners of the cube, the middle of the floor, and a point inside.
std::vector<Eigen::Vector3d> tenPoints();

/// Centres of the three horizontal circles.
std::array<Eigen::Vector3d, 3> circleCenters();

constexpr std::size_t kUpperCircle = 2;  // of circleCenters()

/// The position on a circle at an angle from the x axis [rad].
Eigen::Vector3d onCircle(std::size_t circle, double angle);

/// A random placement of the LED at a point: uniform in a disc of kFloorPlacement on the floor, or
/// in a ball of kAirPlacement above it.
Eigen::Vector3d placed(const Eigen::Vector3d& point, std::mt19937_64& random);

}  // namespace wiimote_tracker::monte_carlo
