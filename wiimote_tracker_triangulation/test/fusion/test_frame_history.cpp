// The images kept of one camera.
#include "wiimote_tracker_triangulation/fusion/frame_history.h"

#include <gtest/gtest.h>

namespace wiimote_tracker::fusion {
namespace {

Frame frameAt(double time) {
  Frame frame;
  frame.time = time;
  frame.arrival = time + 0.5;
  frame.pixel = Eigen::Vector2d(10.0 * time, -time);
  return frame;
}

TEST(FrameHistory, BracketsAnInstant) {
  FrameHistory history;
  EXPECT_FALSE(history.bracket(1.0));
  EXPECT_FALSE(history.firstTimeAfter(0.0));
  for (const double t : {1.0, 2.0, 4.0})
    history.push(frameAt(t));
  EXPECT_EQ(4.0, history.newest().time);
  EXPECT_FALSE(history.bracket(0.9));
  EXPECT_FALSE(history.bracket(4.1));
  const auto between = history.bracket(2.5);
  ASSERT_TRUE(between);
  EXPECT_EQ(2.0, between->before->time);
  EXPECT_EQ(4.0, between->after->time);
  EXPECT_EQ(2.0, between->gap());
  EXPECT_TRUE(between->pixelAt(2.5)->isApprox(Eigen::Vector2d(25.0, -2.5), 1e-15));
  const auto exact = history.bracket(2.0);
  ASSERT_TRUE(exact);
  EXPECT_EQ(exact->before, exact->after);
  EXPECT_EQ(0.0, exact->gap());
  EXPECT_EQ(Eigen::Vector2d(20.0, -2.0), *exact->pixelAt(2.0));
  EXPECT_EQ(2.0, *history.firstTimeAfter(1.0));
  EXPECT_FALSE(history.firstTimeAfter(4.0));
}

TEST(FrameHistory, DoesNotInterpolateAcrossABlindImage) {
  FrameHistory history;
  history.push(frameAt(1.0));
  history.push({2.0, 2.0, std::nullopt});
  history.push(frameAt(3.0));
  EXPECT_FALSE(history.bracket(1.5)->pixelAt(1.5));
  EXPECT_FALSE(history.bracket(2.0)->pixelAt(2.0));
  EXPECT_FALSE(history.bracket(2.5)->pixelAt(2.5));
  EXPECT_TRUE(history.bracket(3.0)->pixelAt(3.0));
}

TEST(FrameHistory, ForgetsOnlyWhatNobodyNeeds) {
  FrameHistory history;
  for (int round = 0; round < 100; ++round) {  // around the ring and through its growth
    for (int i = 0; i < 7; ++i)
      history.push(frameAt(7.0 * round + i));
    const double t = 7.0 * round + 4.5;
    history.forgetBefore(t);
    EXPECT_FALSE(history.bracket(t - 1.0));
    const auto bracket = history.bracket(t);
    ASSERT_TRUE(bracket);
    EXPECT_EQ(t - 0.5, bracket->before->time);
    EXPECT_EQ(t + 0.5, bracket->after->time);
  }
  history.clear();
  EXPECT_TRUE(history.empty());
}

TEST(FrameHistory, IsBounded) {
  FrameHistory history;
  const int count = 3 * static_cast<int>(FrameHistory::kMaximumSize);
  for (int i = 0; i < count; ++i)
    history.push(frameAt(i));
  EXPECT_EQ(count - 1.0, history.newest().time);
  const double oldest = count - static_cast<double>(FrameHistory::kMaximumSize);
  EXPECT_TRUE(history.bracket(oldest));
  EXPECT_FALSE(history.bracket(oldest - 0.5));
}

}  // namespace
}  // namespace wiimote_tracker::fusion
