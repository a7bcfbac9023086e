// A few hours of benchmark_calibration --section month.
#include "month_trial.h"

#include <gtest/gtest.h>

namespace wiimote_tracker {
namespace {

TEST(Month, LosesNothing) {
  Month month(2, 8.0);
  const MonthFigures found = month.run(6);
  EXPECT_EQ(found.wrong, 0u);
  EXPECT_EQ(found.hours_dark, 0u);
  EXPECT_EQ(found.reused_ids, 0u);
  EXPECT_EQ(found.alarms, 0u);
}

TEST(Month, FollowsAClockThatDrifts) {
  Month month(1, 60.0);
  const MonthFigures found = month.run(3);
  // 0.94; 0.95 without drift, 0.77 if it were not followed.
  EXPECT_GT(found.points, 0.92 * found.images);
}

}  // namespace
}  // namespace wiimote_tracker
