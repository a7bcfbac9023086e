// Time per point: methods (0 mean of closest points, 1 least squares, 2 maximum likelihood) by
// views.
#include "geometry/random_rigs.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <benchmark/benchmark.h>

namespace {

using namespace wiimote_tracker::geometry;

void triangulatePoint(benchmark::State& state) {
  TriangulationOptions options;
  options.method = static_cast<TriangulationMethod>(state.range(0));
  test::Random random(1);
  const Rig rig = test::randomRig(random, static_cast<int>(state.range(1)));
  std::vector<Observation> observations;
  for (const RigCamera& camera : rig.cameras) {
    const Eigen::Vector2d noise(random.gaussian(), random.gaussian());
    observations.push_back({&camera.camera, *camera.camera.project({0.1, 0.2, 0.3}) + 0.5 * noise});
  }
  for (auto _ : state)
    benchmark::DoNotOptimize(triangulate(observations, options));
}
BENCHMARK(triangulatePoint)->ArgNames({"method", "views"})->ArgsProduct({{0, 1, 2}, {2, 4, 8}});

}  // namespace

BENCHMARK_MAIN();
