#include "benchmark_calibration_sections.h"
#include "measure_trial.h"

#include <wiimote_tracker_triangulation/geometry/error.h>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker {

namespace {

constexpr int kMeasurements = 6;

/// Sums over the sessions after the same number of measurements.
struct Sums {
  int sessions = 0;
  int tapes = 0;
  double expected = 0.0;  // squares [m^2], as the following
  double error = 0.0;
  double shape = 0.0;
  double promised = 0.0;  // after the next measurement, of sessions with one
  double kept = 0.0;      // as expected then
  double came = 0.0;      // the error then
};

void runRow(const std::string& name,
            const wave::WaveScene& scene,
            int runs,
            const RowCallback& row) {
  std::vector<Sums> all(kMeasurements + 1);
  for (int seed = 1; seed <= runs; ++seed) {
    std::vector<session::MeasureStep> steps;
    try {
      steps = session::runMeasureTrial(scene, static_cast<std::uint64_t>(seed), kMeasurements);
    } catch (const geometry::Error&) {
      continue;  // shown by the number of sessions
    }
    for (std::size_t k = 0; k < all.size(); ++k) {
      // Where nothing more helps, a person stops.
      const session::MeasureStep& step = steps[std::min(k, steps.size() - 1)];
      Sums& sums = all[k];
      ++sums.sessions;
      sums.expected += step.expected * step.expected;
      sums.error += step.error * step.error;
      sums.shape += step.shape * step.shape;
      if (k + 1 >= steps.size())
        continue;
      sums.tapes += step.next->corners ? 1 : 0;
      sums.promised += std::pow(step.next->expected_error, 2);
      sums.kept += std::pow(steps[k + 1].expected, 2);
      sums.came += std::pow(steps[k + 1].error, 2);
    }
  }
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Sums& sums = all[k];
    const auto rms = [&](double squares) { return 1e3 * std::sqrt(squares / sums.sessions); };
    row({name + ", " + std::to_string(k) + " measured",
         {{"sessions", sums.sessions},
          {"expected", rms(sums.expected)},
          {"error", rms(sums.error)},
          {"shape", rms(sums.shape)},
          {"by tape", static_cast<double>(sums.tapes) / sums.sessions},
          {"kept/said", std::sqrt(sums.kept / sums.promised)},
          {"came/said", std::sqrt(sums.came / sums.promised)}}});
  }
}

void runMeasure(int runs, const RowCallback& row) {
  wave::WaveScene scene;
  scene.uncertainty = square::Uncertainty();
  scene.pixel = 0.3;
  for (const std::size_t cameras : {std::size_t{4}, std::size_t{2}}) {
    scene.camera_count = cameras;
    const std::string name = std::to_string(cameras) + " cameras, square";
    scene.duration = 0.0;
    runRow(name, scene, runs, row);
    scene.duration = 15.0;
    runRow(name + " and wave", scene, runs, row);
  }
}

}  // namespace

BenchmarkSection measureSection() {
  return {"measure",
          "what the verdict advises to measure. RMS error [mm] at the verdict's places: expected, "
          "true, expected after the best rigid motion; share of lengths by tape among the next "
          "measurements; RMS after them, expected and true, over the promised.",
          runMeasure};
}

}  // namespace wiimote_tracker
