// Ten days whose hours are short; benchmark_driver --section soak runs whole ones.
#include "trials.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace wiimote_tracker {
namespace {

constexpr double kHour = 5.0;               // [s]
constexpr std::uint64_t kReports = 110000;  // at 100 Hz

TEST(Month, LeavesMemoryAndTimesInOrder) {
  std::map<std::string, double> found;
  for (const Result& result : runSoak(kReports, kHour))
    found[result.name] = result.value;
  EXPECT_GT(found.at("disturbances"), 220.0);
  EXPECT_GT(found.at("images"), 0.9 * kReports);
  EXPECT_GT(found.at("restorations"), 30.0);
  EXPECT_LE(found.at("allocations_not_freed_since_then"), 0.0);
  EXPECT_LT(found.at("lowest_battery"), 0x20);
  EXPECT_EQ(found.at("clock_steps"), 11.0);
  EXPECT_EQ(found.at("clock_steps_not_noticed"), 0.0);
  EXPECT_EQ(found.at("times_not_increasing"), 0.0);
  EXPECT_GT(found.at("stamp_error_rms"), 0.0) << "stamps were judged";
  // The first reports after a pause may be taken for delayed ones.
  EXPECT_LE(found.at("wrong_stamps"), 2.0 * found.at("restorations"));
}

}  // namespace
}  // namespace wiimote_tracker
