#pragma once

#include "wiimote_tracker_calibration/simulation/simulated_wave.h"
#include "wiimote_tracker_calibration/simulation/wave_bound.h"

#include "wiimote_tracker_calibration/wave/solve_wave.h"

#include <cstdint>
#include <string>
#include <vector>

namespace wiimote_tracker::wave {

/// How many of how many.
struct Share {
  int inside = 0;
  int all = 0;
  void count(bool is_inside) {
    inside += is_inside ? 1 : 0;
    ++all;
  }
};

/// RMS errors of single measurements in the cube, after a rigid alignment on other points [m].
struct PositionError {
  double solved = 0.0;   ///< With the cameras of the wave.
  double perfect = 0.0;  ///< With the true cameras.
  double square = 0.0;   ///< With the square alone; NaN when it was refused.
};

/// One simulated calibration, held against the truth.
struct WaveTrial {
  std::string refusal;  ///< Empty: solved.
  VolumeError error;
  VolumeError bound;
  std::vector<double> offset_errors;   ///< Of all cameras but the first [s].
  std::vector<double> offset_bounds;   ///< Standard deviations [s].
  std::vector<double> offset_stddevs;  ///< As the solution states them [s].
  Share intervals;                     ///< Parameters within their 95 % interval.
  Share regions;                       ///< Points within their 95 % ellipsoid.
  double length_error = 0.0;  ///< Mean error of measured wands, as a share of their length.
  PositionError position;
};

/// @param with_positions fills `position`, too.
WaveTrial runWaveTrial(const WaveScene& scene, std::uint64_t seed, bool with_positions);

/// The cameras alone.
std::vector<geometry::Camera> camerasOf(const std::vector<geometry::RigCamera>& cameras);

/// Points of the cube [0, 2.5]^3 m that all true cameras see.
std::vector<Eigen::Vector3d> cubePoints(const std::vector<geometry::Camera>& truth);

/// Errors of the points as triangulated from their true pixels with the estimated cameras [m].
Eigen::Matrix3Xd pointErrors(const std::vector<geometry::Camera>& truth,
                             const std::vector<geometry::Camera>& estimate,
                             const std::vector<Eigen::Vector3d>& points);

/// RMS error of the points of the cube [m].
double volumeError(const std::vector<geometry::RigCamera>& truth, const geometry::Rig& rig);

/// The options that fit to a scene.
WaveOptions optionsFor(const WaveScene& scene);

/// The cameras of a solution in the world of the truth, the cube's: without square and floor they
/// stand in the first camera, whose true place is known here.
std::vector<geometry::Camera> inTrueWorld(const WaveScene& scene,
                                          const SimulatedWave& wave,
                                          const square::Solution& solution);

}  // namespace wiimote_tracker::wave
