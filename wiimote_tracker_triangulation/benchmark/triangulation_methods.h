#ifndef WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_TRIANGULATION_METHODS_H
#define WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_TRIANGULATION_METHODS_H

#include "triangulation_scene.h"

#include <Eigen/Core>

#include <functional>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// What a method makes of all points of a scene. Room is made before the time is taken.
struct TriangulationOutput {
  std::vector<Eigen::Vector3d> positions;    ///< World [m], or in first_camera's axes, see Method.
  std::vector<Eigen::Matrix3d> covariances;  ///< [m^2]; as it was where a method has none.
};

/// A way to intersect rays, ours or a library's.
struct TriangulationMethodUnderTest {
  std::string name;
  bool more_than_two_views;
  bool has_covariance;
  bool in_first_camera;  ///< Positions are in the first camera's axes, not the world's.

  /// Brings a scene into the form that the method reads (lens undone, rays, matrices), which is not
  /// timed, and returns what is.
  std::function<std::function<void(TriangulationOutput*)>(const TriangulationScene&)> prepare;
};

std::vector<TriangulationMethodUnderTest> ourMethods();

/// Those of OpenCV, OpenGV and mrcal, as far as they were there when this was configured.
std::vector<TriangulationMethodUnderTest> peerMethods();

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_TRIANGULATION_METHODS_H
