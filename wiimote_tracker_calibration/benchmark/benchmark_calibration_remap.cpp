#include "benchmark_calibration_sections.h"
#include "deformations.h"
#include "wiimote_tracker_calibration/remap/fit.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_triangulation/remap/correction.h>

#include <cmath>
#include <random>

namespace wiimote_tracker {

namespace {

using namespace remap;

using Deformation = Eigen::Vector3d (*)(const Eigen::Vector3d&);

/// A shifted, sheared cube, as a wrong principal point leaves it.
Eigen::Vector3d affine(const Eigen::Vector3d& p) {
  return p + Eigen::Vector3d(0.1 + 0.02 * p.y(), -0.08 + 0.01 * p.z(), 0.05 - 0.02 * p.x());
}

Eigen::Vector3d projective(const Eigen::Vector3d& p) {
  return affine(p) / (1.0 + 0.02 * p.x() - 0.015 * p.y());
}

Eigen::Vector3d trilinear(const Eigen::Vector3d& p) {
  return affine(p) + 0.015 * p.x() * p.y() * Eigen::Vector3d(1.0, -0.5, 0.2) +
         0.01 * p.x() * p.y() * p.z() * Eigen::Vector3d(0.5, 0.5, -1.0);
}

/// `side` points along each edge of the paper's cube, each known to 5 mm and measured to 2 mm.
BenchmarkRow rowOf(const std::string& name, Deformation deformation, int side, int runs) {
  double before = 0.0;
  double after = 0.0;
  double promised = 0.0;
  int refused = 0;
  int chosen[4] = {};
  constexpr int kChecks = 200;
  for (int seed = 1; seed <= runs; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    std::vector<KnownPoint> points;
    for (int i = 0; i < side * side * side; ++i) {
      const Eigen::Vector3i cell(i % side, i / side % side, i / side / side);
      const Eigen::Vector3d place = 2.5 / (side - 1) * cell.cast<double>();
      points.push_back({place + noise(random, 0.002), deformation(place) + noise(random, 0.005)});
    }
    try {
      const FitResult result = fitRemap(points, "simulated");
      ++chosen[static_cast<int>(result.remap.model)];
      const Correction correction(result.remap, "simulated");
      promised += result.expected_error * result.expected_error;
      std::uniform_real_distribution<double> uniform(0.1, 2.4);
      for (int i = 0; i < kChecks; ++i) {
        const double x = uniform(random);
        const double y = uniform(random);
        const Eigen::Vector3d place(x, y, uniform(random));
        const auto corrected = correction.apply(place, Eigen::Matrix3d::Zero());
        before += (place - deformation(place)).squaredNorm() / kChecks;
        after += (corrected->position - deformation(place)).squaredNorm() / kChecks;
      }
    } catch (const Error&) {
      ++refused;
    }
  }
  const int used = runs - refused;
  return {name + ", " + std::to_string(side * side * side) + " points",
          {{"before", 1e3 * std::sqrt(before / used)},
           {"after", 1e3 * std::sqrt(after / used)},
           {"expected", 1e3 * std::sqrt(promised / used)},
           {"affine", chosen[0]},
           {"projective", chosen[1]},
           {"trilinear", chosen[2]},
           {"thin_plate", chosen[3]},
           {"refused", refused}}};
}

void runRemap(int runs, const RowCallback& row) {
  for (const int side : {2, 3, 4}) {
    row(rowOf("affine", affine, side, runs));
    row(rowOf("projective", projective, side, runs));
    row(rowOf("trilinear", trilinear, side, runs));
    row(rowOf("smooth waves", wavy, side, runs));
  }
}

}  // namespace

BenchmarkSection remapSection() {
  return {"remap",
          "a deformed cube of 2.5 m, corrected from known points on a grid, known to 5 mm and "
          "measured to 2 mm per axis. RMS error of 200 other points inside [mm]: before, after; "
          "the stated expected error, which includes that of the known points [mm]; how often each "
          "model was chosen; refused sessions.",
          runRemap};
}

}  // namespace wiimote_tracker
