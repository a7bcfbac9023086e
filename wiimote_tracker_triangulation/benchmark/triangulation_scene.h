#ifndef WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_TRIANGULATION_SCENE_H
#define WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_TRIANGULATION_SCENE_H

#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <Eigen/Core>

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

/// The paper's Fig. 1: a cube of 2.5 m, cameras 4.5 m outside its vertical edges, 2 m high. Fewer
/// than four: neighbours. Beyond four: between them.
TriangulationScene paperScene(int cameras, int points, unsigned seed);

/// A cube of 1.5 m, cameras on a ring of 4.1 m around it, a quarter turn apart (eighths beyond
/// four), 1 m above its middle: the ranges differ more, and the cameras lie nearer.
TriangulationScene ringScene(int cameras, int points, unsigned seed);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_TRIANGULATION_SCENE_H
