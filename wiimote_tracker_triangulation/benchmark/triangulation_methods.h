#ifndef WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_TRIANGULATION_METHODS_H
#define WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_TRIANGULATION_METHODS_H

#include "triangulation_scene.h"

#include <Eigen/Core>

#include <functional>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// A method's results for all points of a scene. Memory is allocated before the timing.
struct TriangulationOutput {
  std::vector<Eigen::Vector3d> positions;    ///< World [m], or in first_camera's axes, see Method.
  std::vector<Eigen::Matrix3d> covariances;  ///< [m^2]; unchanged where a method has none.
};

/// A way to intersect rays, ours or a library's.
struct TriangulationMethodUnderTest {
  std::string name;
  bool has_covariance;
  bool in_first_camera;  ///< Positions are in the first camera's axes, not the world's.

  /// Converts a scene to the method's input (undistorted pixels, rays, matrices) and returns the
  /// function to be timed.
  std::function<std::function<void(TriangulationOutput*)>(const TriangulationScene&)> prepare;
};

std::vector<TriangulationMethodUnderTest> ourMethods();

/// Those of OpenCV, OpenGV and mrcal that were found when this was configured.
std::vector<TriangulationMethodUnderTest> peerMethods();

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_TRIANGULATION_METHODS_H
