#include "bundle_synthetic_rig.h"
#include "expect_says.h"

#include "../src/self_calibrate/report.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace wiimote_tracker::self_calibrate {
namespace {

/// What is printed when every `spoiled`-th observation fits no point.
std::string printedWith(std::size_t spoiled, bool converged = true) {
  const bundle::SyntheticRig rig(3, 60, 33);
  Report report;
  bundle::Reconstruction& solution = report.solution.reconstruction;
  solution.cameras = rig.cameras;
  solution.observations = rig.observations;
  solution.points.assign(rig.points.begin(), rig.points.end());
  for (std::size_t i = 0; i < rig.observations.size(); ++i)
    solution.inliers.push_back(i % spoiled != 0);
  // What one camera alone saw fits no point either, but says nothing.
  for (std::size_t i = 0; i < 100; ++i) {
    solution.observations.push_back({0, solution.points.size(), {300.0, 200.0}});
    solution.points.emplace_back();
    solution.inliers.push_back(false);
  }
  solution.converged = converged;
  report.solution.lenses.assign(rig.cameras.size(), {1.0, true});
  char* text = nullptr;
  std::size_t size = 0;
  std::FILE* file = open_memstream(&text, &size);
  print(report, false, file);
  std::fclose(file);
  const std::string printed(text, size);
  std::free(text);
  return printed;
}

TEST(SelfCalibrateReport, SaysThatManyObservationsFitNoPoint) {
  EXPECT_SAYS(printedWith(4), "OBSERVATIONS FIT NO POINT");
  EXPECT_EQ(printedWith(20).find("OBSERVATIONS FIT NO POINT"), std::string::npos);
}

TEST(SelfCalibrateReport, SaysThatTheAdjustmentDidNotConverge) {
  EXPECT_SAYS(printedWith(20, false), "NO FINAL SOLUTION");
  EXPECT_EQ(printedWith(20).find("NO FINAL SOLUTION"), std::string::npos);
}

}  // namespace
}  // namespace wiimote_tracker::self_calibrate
