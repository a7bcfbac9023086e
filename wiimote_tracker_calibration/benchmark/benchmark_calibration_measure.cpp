#include "benchmark_calibration_sections.h"
#include "measure_trial.h"
#include "rms.h"

#include <wiimote_tracker_triangulation/geometry/error.h>

#include <algorithm>
#include <string>
#include <vector>

namespace wiimote_tracker {

namespace {

using samples::MeasureStep;

constexpr int kMeasurements = 6;

void runRow(const std::string& name,
            const wave::WaveScene& scene,
            int runs,
            const RowCallback& row) {
  std::vector<std::vector<MeasureStep>> sessions;
  for (int seed = 1; seed <= runs; ++seed) {
    try {
      sessions.push_back(
          samples::runMeasureTrial(scene, static_cast<std::uint64_t>(seed), kMeasurements));
    } catch (const geometry::Error&) {
      continue;  // shown by the number of sessions
    }
  }
  for (std::size_t k = 0; k <= kMeasurements; ++k) {
    // Where nothing more helps, a person stops: the last step stands for those that follow.
    std::vector<MeasureStep> all, measuring, then;
    double tapes = 0.0;
    for (const std::vector<MeasureStep>& steps : sessions) {
      all.push_back(steps[std::min(k, steps.size() - 1)]);
      if (k + 1 >= steps.size())
        continue;
      measuring.push_back(steps[k]);
      then.push_back(steps[k + 1]);
      tapes += steps[k].next->corners ? 1.0 : 0.0;
    }
    const double said =
        rms(measuring, [](const MeasureStep& step) { return step.next->expected_error; });
    row({name + ", " + std::to_string(k) + " measured",
         {{"sessions", sessions.size()},
          {"expected", 1e3 * rms(all, &MeasureStep::expected)},
          {"error", 1e3 * rms(all, &MeasureStep::error)},
          {"shape", 1e3 * rms(all, &MeasureStep::shape)},
          {"by tape", tapes / static_cast<double>(sessions.size())},
          {"kept/said", rms(then, &MeasureStep::expected) / said},
          {"came/said", rms(then, &MeasureStep::error) / said}}});
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
