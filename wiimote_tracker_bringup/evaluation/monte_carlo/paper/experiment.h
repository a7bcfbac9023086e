#ifndef WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_PAPER_EXPERIMENT_H
#define WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_PAPER_EXPERIMENT_H

#include <Eigen/Core>

#include <array>
#include <random>
#include <vector>

// Where the paper puts its LED (section V.B). World z up [m]; the paper has z into the floor: its
// point (x, y, -h) is (x, y, h) here.
namespace wiimote_tracker::monte_carlo {

constexpr double kSide = 2.5;  // of the square and of the cube over it
constexpr double kCircleRadius = 0.75;
constexpr double kFloorPlacement = 0.01;  // largest error of putting the LED on the floor
constexpr double kAirPlacement = 0.03;    // and above it

/// The corners of the cube, the middle of the floor, and a point inside.
std::vector<Eigen::Vector3d> tenPoints();

/// Centres of the three circles, which lie level.
std::array<Eigen::Vector3d, 3> circleCenters();

/// Where the LED is put instead of at a point: anywhere in a disc of kFloorPlacement on the floor,
/// or in a ball of kAirPlacement above it.
Eigen::Vector3d placed(const Eigen::Vector3d& point, std::mt19937_64& random);

}  // namespace wiimote_tracker::monte_carlo

#endif  // WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_PAPER_EXPERIMENT_H
