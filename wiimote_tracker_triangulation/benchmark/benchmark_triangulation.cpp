// Accuracy and time of triangulation, ours and OpenCV's, in one table: RMS over the
// Cramer-Rao bound, normalised error squared (3 when the covariance is consistent), time per point.
#include "benchmark_program.h"
#include "triangulation_scene.h"

#include <wiimote_tracker_msgs/median.h>

#include <Eigen/LU>

#include <chrono>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

using namespace wiimote_tracker;

namespace {

constexpr int kTimedPoints = 1000;
constexpr int kRepetitions = 21;  // of each method, taken in turn against drift

/// RMS over the bound, and NEES: NaN for a method without covariance.
std::pair<double, double> errors(const TriangulationScene& scene,
                                 const TriangulationOutput& output) {
  double squared = 0.0;
  double nees = 0.0;
  for (std::size_t i = 0; i < scene.truth.size(); ++i) {
    const Eigen::Vector3d error = output.positions[i] - scene.truth[i];
    squared += error.squaredNorm();
    nees += error.dot(output.covariances[i].inverse() * error);
  }
  const auto count = static_cast<double>(scene.truth.size());
  return {std::sqrt(squared / count) / scene.bound, nees / count};
}

double secondsOf(const std::function<void(TriangulationOutput*)>& run,
                 TriangulationOutput* output) {
  const auto begin = std::chrono::steady_clock::now();
  run(output);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::vector<BenchmarkRow> measure(const TriangulationScene& scene) {
  const auto methods = triangulationMethods(scene.cameras.size());
  TriangulationScene part = scene;
  part.truth.resize(kTimedPoints);
  part.pixels.resize(part.truth.size());
  TriangulationOutput part_output(part.truth.size());
  std::vector<BenchmarkRow> rows;
  std::vector<std::function<void(TriangulationOutput*)>> timed;
  for (const TriangulationMethod& method : methods) {
    TriangulationOutput output(scene.truth.size());
    method.prepare(scene)(&output);
    const auto [rms_over_bound, nees] = errors(scene, output);
    rows.push_back(
        {scene.name + " cameras, " + method.name,
         {{"bound [mm]", 1e3 * scene.bound}, {"RMS / bound", rms_over_bound}, {"NEES", nees}}});
    timed.push_back(method.prepare(part));
  }
  std::vector<std::vector<double>> seconds(methods.size());
  for (int i = 0; i < kRepetitions; ++i) {
    for (std::size_t m = 0; m < methods.size(); ++m)
      seconds[m].push_back(secondsOf(timed[m], &part_output));
  }
  for (std::size_t m = 0; m < methods.size(); ++m) {
    rows[m].figures.emplace_back(
        "ns / point", 1e9 * medianOf(&seconds[m]) / static_cast<double>(part.truth.size()));
  }
  return rows;
}

void run(const BenchmarkSettings& settings, const RowCallback& row) {
  for (const TriangulationLayout& layout : kTriangulationLayouts) {
    for (const int cameras : {2, 4}) {
      const auto scene = makeScene(layout, cameras, kTimedPoints * settings.runs, settings.seed);
      for (const BenchmarkRow& result : measure(scene))
        row(result);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  return runBenchmark(
      "benchmark_triangulation",
      {{"triangulation",
        "1000 points per --runs, 0.5 px of noise, lenses without distortion. Time: median of 21 "
        "runs over 1000 points, methods in turn, from rays that are ready unless it says from "
        "pixels. Only ours give a covariance. ring: cameras on a circle.",
        run}},
      argc, argv);
}
