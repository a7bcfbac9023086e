// What must not change a rig that corrects itself: other lights, masked cameras, rest.
#include "benchmark_calibration_sections.h"
#include "misled_trial.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace wiimote_tracker {

namespace {

constexpr double kMostWorse = 0.001;  // [m]

void runMisled(int runs, const RowCallback& row) {
  const std::pair<Misled, const char*> kCauses[] = {{Misled::kMirror, "a mirror"},
                                                    {Misled::kOtherLed, "another LED"},
                                                    {Misled::kCarried, "another LED carried along"},
                                                    {Misled::kLamp, "a lamp"},
                                                    {Misled::kMasked, "masked"},
                                                    {Misled::kTwoLights, "two other lights"}};
  for (const auto& [by, name] : kCauses) {
    int changes = 0;
    int worse = 0;
    double worst = 0.0;
    for (int run = 0; run < runs; ++run) {
      const MisledTrial trial = runMisledTrial(by, static_cast<std::uint64_t>(run) + 1);
      changes += trial.changes;
      worse += trial.worse > kMostWorse ? 1 : 0;
      worst = std::max(worst, trial.worse);
    }
    row({name, {{"changes", changes}, {"worse", worse}, {"worst_mm", 1000.0 * worst}}});
  }
}

void runRest(int runs, const RowCallback& row) {
  row({"one LED rests", {{"changes", changesAtRest(true, runs, 1)}}});
  row({"no LED", {{"changes", changesAtRest(false, runs, 2)}}});
}

}  // namespace

BenchmarkSection misledSection() {
  return {"misled",
          "one or two of four cameras see another light than the LED, or none, for 45 s: changes "
          "of the rig, runs in which the volume's RMS error grew by more than 1 mm, its largest "
          "growth",
          runMisled};
}

BenchmarkSection restSection() {
  return {"rest", "changes of the rig in 24 hours without motion, as many seconds of each as runs",
          runRest};
}

}  // namespace wiimote_tracker
