// Accuracy and time of triangulation, ours and other libraries', in one table: RMS over the
// Cramer-Rao bound, normalised error squared (3 when the covariance is consistent), time per point.
#include "triangulation_methods.h"

#include <wiimote_tracker_msgs/argument_parser.h>
#include <wiimote_tracker_msgs/text.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

using namespace wiimote_tracker;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kTimedPoints = 1000;
constexpr int kRepetitions = 21;  // of each method, taken in turn against drift

struct Row {
  std::string method;
  std::size_t views;
  double rms_over_bound;
  double nees;         // NaN: the method has no covariance
  double nanoseconds;  // per point, median
};

/// RMS over the bound and NEES.
void score(const TriangulationScene& scene,
           const TriangulationMethodUnderTest& method,
           const TriangulationOutput& output,
           Row* row) {
  double squared = 0.0;
  double nees = 0.0;
  for (std::size_t i = 0; i < scene.truth.size(); ++i) {
    Eigen::Vector3d position = output.positions[i];
    if (method.in_first_camera)
      position = scene.cameras[0].world_from_camera * position;
    const Eigen::Vector3d error = position - scene.truth[i];
    squared += error.squaredNorm();
    if (method.has_covariance)
      nees += error.dot(output.covariances[i].ldlt().solve(error));
  }
  const auto count = static_cast<double>(scene.truth.size());
  row->rms_over_bound = std::sqrt(squared / count) / scene.bound;
  row->nees = method.has_covariance ? nees / count : kNaN;
}

double secondsOf(const std::function<void(TriangulationOutput*)>& run,
                 TriangulationOutput* output) {
  const auto begin = std::chrono::steady_clock::now();
  run(output);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

TriangulationScene firstPoints(const TriangulationScene& scene) {
  TriangulationScene part = scene;
  part.truth.resize(std::min(part.truth.size(), kTimedPoints));
  part.pixels.resize(part.truth.size());
  return part;
}

TriangulationOutput roomFor(const TriangulationScene& scene) {
  TriangulationOutput output;
  output.positions.resize(scene.truth.size());
  output.covariances.resize(scene.truth.size());
  return output;
}

std::vector<Row> measure(const TriangulationScene& scene) {
  std::vector<TriangulationMethodUnderTest> methods = ourMethods();
  if (scene.cameras.size() == 2) {
    for (const TriangulationMethodUnderTest& peer : peerMethods())
      methods.push_back(peer);
  }
  TriangulationOutput output = roomFor(scene);
  const TriangulationScene part = firstPoints(scene);
  TriangulationOutput part_output = roomFor(part);
  std::vector<Row> rows;
  std::vector<std::function<void(TriangulationOutput*)>> timed;
  for (const TriangulationMethodUnderTest& method : methods) {
    rows.push_back({method.name, scene.cameras.size(), kNaN, kNaN, kNaN});
    method.prepare(scene)(&output);
    score(scene, method, output, &rows.back());
    timed.push_back(method.prepare(part));
  }
  std::vector<std::vector<double>> seconds(methods.size());
  for (int i = 0; i < kRepetitions; ++i) {
    for (std::size_t m = 0; m < methods.size(); ++m)
      seconds[m].push_back(secondsOf(timed[m], &part_output));
  }
  for (std::size_t m = 0; m < methods.size(); ++m) {
    std::sort(seconds[m].begin(), seconds[m].end());
    rows[m].nanoseconds =
        1e9 * seconds[m][kRepetitions / 2] / static_cast<double>(part.truth.size());
  }
  return rows;
}

/// With all digits; JSON has no NaN.
std::string jsonNumber(double value) {
  const std::string text = format("%.9g", value);
  return std::isfinite(value) ? text : "null";
}

void print(const TriangulationScene& scene, const std::vector<Row>& rows) {
  std::printf("\n%s cameras, bound %.3f mm\n", scene.name.c_str(), 1e3 * scene.bound);
  std::printf("  %-34s %12s %8s %10s\n", "", "RMS / bound", "NEES", "ns / point");
  for (const Row& row : rows) {
    std::printf("  %-34s %12.4f ", row.method.c_str(), row.rms_over_bound);
    if (std::isfinite(row.nees))
      std::printf("%8.3f", row.nees);
    else
      std::printf("%8s", "-");
    std::printf(" %10.0f\n", row.nanoseconds);
  }
  std::fflush(stdout);
}

void write(const TriangulationScene& scene,
           const std::vector<Row>& rows,
           bool first,
           std::FILE* json) {
  std::fprintf(json, "%s\n \"%s\": [", first ? "" : ",", scene.name.c_str());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::fprintf(json,
                 "%s\n  {\"method\": \"%s\", \"views\": %zu, \"bound_m\": %s, "
                 "\"rms_over_bound\": %s, \"nees\": %s, \"ns_per_point\": %s}",
                 i == 0 ? "" : ",", rows[i].method.c_str(), rows[i].views,
                 jsonNumber(scene.bound).c_str(), jsonNumber(rows[i].rms_over_bound).c_str(),
                 jsonNumber(rows[i].nees).c_str(), jsonNumber(rows[i].nanoseconds).c_str());
  }
  std::fprintf(json, "\n ]");
}

/// @param path of the JSON; empty: none. @returns the exit status.
int run(int points, unsigned seed, const std::string& path) {
  std::FILE* json = path.empty() ? nullptr : std::fopen(path.c_str(), "w");
  if (!path.empty() && !json) {
    std::perror(path.c_str());
    return 1;
  }

  std::printf(
      "Simulated: %d points, %.1f px of noise, lenses without distortion, seed %u.\n"
      "Time: median of %d runs over %zu points, methods in turn, from rays that are ready unless "
      "it "
      "says\nfrom pixels. Ours give the covariance, the others the point only; a plain midpoint of "
      "two rays, as\nOpenGV's, is the fastest that there is.\n",
      points, kBenchmarkPixelStddev, seed, kRepetitions, kTimedPoints);
  bool first = true;
  if (json)
    std::fprintf(json, "{");
  for (const auto make : {paperScene, ringScene}) {
    for (const int cameras : {2, 3, 4, 8}) {
      const TriangulationScene scene = make(cameras, points, seed);
      const std::vector<Row> rows = measure(scene);
      print(scene, rows);
      if (json)
        write(scene, rows, first, json);
      first = false;
    }
  }
  if (json)
    std::fprintf(json, "\n}\n");
  if (json && std::fclose(json) != 0) {
    std::perror(path.c_str());
    return 1;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  int points = 100000;
  unsigned seed = 1;
  std::string path;
  ArgumentParser parser("benchmark_triangulation",
                        "Errors of triangulated points beside the bound, and the time they take.");
  parser.option("--points N", &points, 100, 1000000000, "points per row");
  parser.option("--seed N", &seed, 0, 4294967295, "of the random numbers");
  parser.option("--json FILE", &path, "write the tables to this file, too");
  return parser.run(argc, argv, [&] { return run(points, seed, path); });
}
