// Time per point: methods (0 mean of closest points, 1 least squares, 2 maximum likelihood) by
// views, with covariance; from pixels, and from sights that are ready. OpenCV's two-view method,
// the point only, beside them.
#include "geometry/random_rigs.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <benchmark/benchmark.h>
#include <opencv2/calib3d.hpp>

#include <vector>

namespace {

using namespace wiimote_tracker::geometry;

/// A rig and one point as its cameras see it.
struct Scene {
  explicit Scene(int views) {
    test::Random random(1);
    rig = test::randomRig(random, views);
    for (const RigCamera& camera : rig.cameras) {
      const Eigen::Vector2d noise(random.gaussian(), random.gaussian());
      observations.push_back(
          {&camera.camera, *camera.camera.project({0.1, 0.2, 0.3}) + 0.5 * noise});
    }
  }
  Rig rig;
  std::vector<Observation> observations;
};

TriangulationOptions optionsOf(const benchmark::State& state) {
  TriangulationOptions options;
  options.method = static_cast<TriangulationMethod>(state.range(0));
  return options;
}

void fromPixels(benchmark::State& state) {
  const TriangulationOptions options = optionsOf(state);
  const Scene scene(static_cast<int>(state.range(1)));
  for (auto _ : state)
    benchmark::DoNotOptimize(triangulate(scene.observations, options));
}
BENCHMARK(fromPixels)->ArgNames({"method", "views"})->ArgsProduct({{0, 1, 2}, {2, 4, 8}});

void fromSights(benchmark::State& state) {
  const TriangulationOptions options = optionsOf(state);
  const Scene scene(static_cast<int>(state.range(1)));
  std::vector<Sight> sights;
  for (const Observation& o : scene.observations)
    sights.push_back(*sightFromPixel(*o.camera, o.pixel));
  for (auto _ : state)
    benchmark::DoNotOptimize(triangulate(sights.data(), sights.size(), options));
}
BENCHMARK(fromSights)->ArgNames({"method", "views"})->ArgsProduct({{0, 1, 2}, {2, 4, 8}});

void oneSight(benchmark::State& state) {
  const Scene scene(1);
  for (auto _ : state)
    benchmark::DoNotOptimize(
        sightFromPixel(*scene.observations[0].camera, scene.observations[0].pixel));
}
BENCHMARK(oneSight);

void opencvTwoViews(benchmark::State& state) {
  const cv::Mat_<double> first = cv::Mat_<double>::eye(3, 4);
  cv::Mat_<double> second = first.clone();
  second(0, 3) = -1.0;
  const int points = static_cast<int>(state.range(0));
  const cv::Mat_<double> left(2, points, 0.1);
  const cv::Mat_<double> right(2, points, 0.05);
  cv::Mat_<double> homogeneous;
  for (auto _ : state)
    cv::triangulatePoints(first, second, left, right, homogeneous);
  state.SetItemsProcessed(state.iterations() * points);
}
BENCHMARK(opencvTwoViews)->ArgName("points")->Arg(1)->Arg(1000);

}  // namespace

BENCHMARK_MAIN();
