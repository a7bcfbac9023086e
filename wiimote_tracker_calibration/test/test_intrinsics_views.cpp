#include "board_lenses.h"
#include "expect_says.h"

#include "intrinsics/view_collector.h"
#include "wiimote_tracker_calibration/intrinsics/solve_intrinsics.h"

#include <wiimote_tracker_msgs/error.h>

#include <gtest/gtest.h>

#include <string>

namespace wiimote_tracker::intrinsics {
namespace {

/// The board as a rectangle in the image, LED 0 at its top left.
BoardView frontView(double left, double top, double side) {
  BoardView view;
  for (int led = 0; led < kBoardLeds; ++led) {
    const int row = led / 4;
    view.pixels[static_cast<std::size_t>(led)] =
        Eigen::Vector2d(left + side * (led % 4) / 3.0, top + side * row / 3.0);
  }
  return view;
}

TEST(ViewCollector, BarsAreThoseOfTheDefinition) {
  ViewCollector collector(Board(), 1024, 768, 12);
  EXPECT_FALSE(collector.coverage().enough());
  EXPECT_EQ(collector.add(frontView(0.0, 0.0, 200.0)), "");
  EXPECT_EQ(collector.add(frontView(412.0, 568.0, 200.0)), "");
  const Coverage coverage = collector.coverage();
  EXPECT_NEAR(coverage.x, (412.0 / 824.0) / 0.7, 1e-6);
  EXPECT_NEAR(coverage.y, 1.0, 1e-6);
  EXPECT_NEAR(coverage.size, 200.0 / std::sqrt(1024.0 * 768.0) / 0.4, 1e-6);
  EXPECT_NEAR(coverage.skew, 0.0, 1e-6);
  EXPECT_EQ(coverage.missing.size(), 4u);  // views, x, size, skew
}

TEST(ViewCollector, RefusesABoardWithoutSpacing) {
  EXPECT_THROW(ViewCollector(Board{0.0, 0.1}, 1024, 768, 12), Error);
}

TEST(ViewCollector, KeepsWhatDiffersAndSaysWhyNot) {
  ViewCollector collector(Board(), 1024, 768, 12);
  EXPECT_EQ(collector.add(frontView(100.0, 100.0, 200.0)), "");
  EXPECT_SAYS(collector.add(frontView(110.0, 105.0, 200.0)), "too much like");
  EXPECT_EQ(collector.samples().views.size(), 1u);
  collector.undo();
  EXPECT_EQ(collector.add(frontView(110.0, 105.0, 200.0)), "");
  BoardView few;
  few.pixels[0] = few.pixels[5] = Eigen::Vector2d(1.0, 2.0);
  EXPECT_SAYS(collector.add(few), "fewer than 6");
}

TEST(ViewCollector, CompleteCoverageSufficesToSolve) {
  std::mt19937 random(3);
  ViewCollector collector(Board(), 1024, 768, 12);
  for (int i = 0; i < 2000 && !collector.coverage().enough(); ++i)
    collector.add(simulatedView(paperCamera(), randomPose(random), 0.5, random));
  ASSERT_TRUE(collector.coverage().enough());
  EXPECT_GE(collector.samples().views.size(), 12u);
  EXPECT_LT(collector.samples().views.size(), 60u);
  const IntrinsicsSolution solution = solveIntrinsics(collector.samples(), SolverOptions());
  EXPECT_NEAR(solution.intrinsics.fx, 1306.3, 40.0);
}

}  // namespace
}  // namespace wiimote_tracker::intrinsics
