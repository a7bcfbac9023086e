// The images kept of one camera, and its spots from one to the next.
#include "wiimote_tracker_triangulation/fusion/frame_history.h"

#include "fusion/synchronizer.h"

#include <gtest/gtest.h>

namespace wiimote_tracker::fusion {
namespace {

using Eigen::Vector2d;

struct Stamp {
  double time = 0.0;
};

using History = FrameHistory<Stamp>;

TEST(FrameHistory, BracketsAnInstant) {
  History history;
  EXPECT_FALSE(history.bracket(1.0));
  EXPECT_FALSE(history.firstTimeAfter(0.0));
  for (const double t : {1.0, 2.0, 4.0})
    history.push({t});
  EXPECT_EQ(4.0, history.newest().time);
  EXPECT_FALSE(history.bracket(0.9));
  EXPECT_FALSE(history.bracket(4.1));
  const auto between = history.bracket(2.5);
  ASSERT_TRUE(between);
  EXPECT_EQ(2.0, between->before->time);
  EXPECT_EQ(4.0, between->after->time);
  EXPECT_EQ(2.0, between->gap());
  EXPECT_EQ(0.25, between->shareAt(2.5));
  const auto exact = history.bracket(2.0);
  ASSERT_TRUE(exact);
  EXPECT_EQ(exact->before, exact->after);
  EXPECT_EQ(0.0, exact->gap());
  EXPECT_EQ(0.0, exact->shareAt(2.0));
  EXPECT_EQ(2.0, history.lastUpTo(3.9)->time);
  EXPECT_EQ(4.0, history.lastUpTo(5.0)->time);
  EXPECT_EQ(nullptr, history.lastUpTo(0.9));
  EXPECT_EQ(2.0, *history.firstTimeAfter(1.0));
  EXPECT_FALSE(history.firstTimeAfter(4.0));
}

TEST(FrameHistory, DropsOnlyFramesThatAreNotNeeded) {
  History history;
  for (int round = 0; round < 100; ++round) {  // around the ring and through its growth
    for (int i = 0; i < 7; ++i)
      history.push({7.0 * round + i});
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
  History history;
  const int count = 3 * static_cast<int>(History::kMaximumSize);
  for (int i = 0; i < count; ++i)
    history.push({static_cast<double>(i)});
  EXPECT_EQ(count - 1.0, history.newest().time);
  const double oldest = count - static_cast<double>(History::kMaximumSize);
  EXPECT_TRUE(history.bracket(oldest));
  EXPECT_FALSE(history.bracket(oldest - 0.5));
}

Frame frameOf(double time, const std::vector<Vector2d>& pixels, const std::vector<int>& slots) {
  Frame frame;
  frame.time = time;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    frame.spots.emplace_back();
    frame.spots.back().pixel = pixels[i];
    frame.spots.back().slot = slots.empty() ? -1 : slots[i];
  }
  return frame;
}

std::vector<int> linksOf(const Frame& frame) {
  std::vector<int> links;
  for (const FrameSpot& spot : frame.spots)
    links.push_back(spot.before);
  return links;
}

constexpr double kSpeed = 5000.0;  // [px/s]

TEST(FollowSpots, MatchesNearestWithinTheMaximumSpeed) {
  const Frame before = frameOf(1.0, {{100.0, 100.0}, {200.0, 100.0}, {800.0, 500.0}}, {});
  Frame frame = frameOf(1.01, {{205.0, 104.0}, {600.0, 500.0}, {96.0, 97.0}}, {});
  followSpots(before, kSpeed, &frame);
  EXPECT_EQ((std::vector<int>{1, kNoSpot, 0}), linksOf(frame));
  EXPECT_NEAR(0.0, (frame.spots[0].velocity - Vector2d(500.0, 400.0)).norm(), 1e-6);
}

TEST(FollowSpots, CrossingSpotsAreNotExchanged) {
  // Towards each other along one line, 40 px per image; they meet between two images.
  Frame before = frameOf(1.0, {{100.0, 100.0}, {250.0, 102.0}}, {});
  Frame frame;
  for (int i = 1; i <= 3; ++i) {
    frame = frameOf(1.0 + 0.01 * i, {{250.0 - 40.0 * i, 102.0}, {100.0 + 40.0 * i, 100.0}}, {});
    followSpots(before, kSpeed, &frame);
    EXPECT_EQ(i == 1 ? (std::vector<int>{1, 0}) : (std::vector<int>{0, 1}), linksOf(frame));
    before = frame;
  }
}

TEST(FollowSpots, SlotsOnlyDecideTies) {
  const Frame before = frameOf(1.0, {{100.0, 100.0}, {104.0, 100.0}}, {0, 1});
  Frame near = frameOf(1.01, {{102.1, 100.0}, {106.0, 100.0}}, {1, 0});
  followSpots(before, kSpeed, &near);
  EXPECT_EQ((std::vector<int>{0, 1}), linksOf(near)) << "both slots change, but the places do not";
  Frame doubtful = frameOf(1.01, {{102.1, 100.0}}, {0});
  followSpots(before, kSpeed, &doubtful);
  EXPECT_EQ(0, doubtful.spots[0].before) << "equal distances: the slot decides";
  Frame far = frameOf(1.01, {{130.0, 100.0}, {100.0, 100.0}}, {0, 1});
  followSpots(before, kSpeed, &far);
  EXPECT_EQ((std::vector<int>{1, 0}), linksOf(far)) << "the slots were exchanged";
}

TEST(FollowSpots, MoreSpotsThanCanBeFollowed) {
  std::vector<Vector2d> pixels;
  for (int i = 0; i < 20; ++i)
    pixels.emplace_back(60.0 * i, 10.0);
  const Frame before = frameOf(1.0, pixels, {});
  Frame frame = frameOf(1.01, pixels, {});
  followSpots(before, kSpeed, &frame);
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(i < 16 ? i : kNoSpot, frame.spots[static_cast<std::size_t>(i)].before);
}

}  // namespace
}  // namespace wiimote_tracker::fusion
