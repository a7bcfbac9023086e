#ifndef WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_TRIANGULATION_SCENE_H
#define WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_TRIANGULATION_SCENE_H

#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace wiimote_tracker {

constexpr double kBenchmarkPixelStddev = 0.5;  ///< Of each pixel coordinate [px].

/// Points seen by all of some cameras, which have no distortion; noise is Gaussian. Simulated
/// without any measured code.
struct TriangulationScene {
  std::string name;
  std::vector<geometry::Camera> cameras;
  std::vector<Eigen::Vector3d> truth;                ///< World [m].
  std::vector<std::vector<Eigen::Vector2d>> pixels;  ///< For each point one for each camera [px].
  double bound;  ///< Cramer-Rao bound on the RMS distance of unbiased estimates [m].
};

/// A cube, and cameras a quarter turn apart (eighths beyond four) about it, which see its middle.
struct TriangulationLayout {
  const char* name;
  double distance;  ///< Of the cameras from the cube's axis [m].
  double height;    ///< Above its middle [m].
  double side;      ///< [m]
};

/// The paper's Fig. 1: cameras 4.5 m outside the cube's vertical edges, 2 m high. Then a ring: the
/// ranges differ more, and the cameras lie nearer.
constexpr TriangulationLayout kTriangulationLayouts[] = {{"paper", 1.25 * M_SQRT2 + 4.5, 0.75, 2.5},
                                                         {"ring", 4.1, 1.0, 1.5}};

TriangulationScene makeScene(const TriangulationLayout& layout,
                             int cameras,
                             int points,
                             unsigned seed);

/// A method's results for all points of a scene. Memory is allocated before the timing.
struct TriangulationOutput {
  explicit TriangulationOutput(std::size_t points);

  std::vector<Eigen::Vector3d> positions;    ///< World [m].
  std::vector<Eigen::Matrix3d> covariances;  ///< [m^2]; NaN where a method has none.
};

/// A way to intersect rays, ours or OpenCV's.
struct TriangulationMethod {
  std::string name;

  /// Converts a scene to the method's input (undistorted pixels, rays, matrices) and returns the
  /// function to be timed.
  std::function<std::function<void(TriangulationOutput*)>(const TriangulationScene&)> prepare;
};

/// All for this number of cameras; OpenCV's takes two, and is there where OpenCV is.
std::vector<TriangulationMethod> triangulationMethods(std::size_t cameras);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_TRIANGULATION_SCENE_H
