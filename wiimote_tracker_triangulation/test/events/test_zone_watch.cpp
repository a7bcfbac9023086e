// Enter and leave events: one of each per visit, whatever the noise; times and places of crossings
// against closed forms; LEDs that come, go and are lost; zones that change.
#include "events/zone_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace wiimote_tracker::events {
namespace {

using Eigen::Vector3d;
using tracking::TrackState;

const geometry::Zone kBox{"box", {0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}};

tracking::TrackedLed led(const Vector3d& position,
                         std::uint32_t id = 7,
                         TrackState state = TrackState::kTracked) {
  tracking::TrackedLed result;
  result.id = id;
  result.state = state;
  result.position = position;
  return result;
}

tracking::Snapshot snapshotAt(double time, const std::vector<tracking::TrackedLed>& leds) {
  tracking::Snapshot result;
  result.time = time;
  result.leds = leds;
  return result;
}

class ZoneWatchTest : public testing::Test {
 protected:
  ZoneWatchTest() { watch_.setZones({kBox}); }

  void show(double time, const std::vector<tracking::TrackedLed>& leds) {
    for (const ZoneCrossing& crossing : watch_.update(snapshotAt(time, leds)))
      events_.push_back(crossing);
  }

  /// Such as "+box7 -box7", in the order of the events.
  std::string story() const {
    std::string words;
    for (const ZoneCrossing& event : events_)
      words += (words.empty() ? "" : " ") + std::string(event.entered ? "+" : "-") + event.zone +
               std::to_string(event.led);
    return words;
  }

  ZoneWatch watch_{ZoneWatchOptions()};
  std::vector<ZoneCrossing> events_;
};

TEST_F(ZoneWatchTest, KnowsWhenAndWhereTheBorderWasCrossed) {
  // At 2 m/s through the box, in at x = 0 after 0.25 s, out at x = 1 after 0.75 s.
  for (int i = 0; i <= 100; ++i)
    show(1e9 + 0.01 * i, {led({-0.5 + 0.02 * i, 0.3, 0.4})});
  ASSERT_EQ("+box7 -box7", story());
  EXPECT_NEAR(1e9 + 0.25, events_[0].time, 1e-6);
  EXPECT_NEAR(1e9 + 0.75, events_[1].time, 1e-6);
  EXPECT_LT((events_[0].position - Vector3d(0.0, 0.3, 0.4)).norm(), 1e-12);
  EXPECT_LT((events_[1].position - Vector3d(1.0, 0.3, 0.4)).norm(), 1e-12);
}

TEST_F(ZoneWatchTest, ReportsALedThatBeginsInside) {
  show(5.0, {led({0.5, 0.5, 0.5})});
  ASSERT_EQ("+box7", story());
  EXPECT_EQ(5.0, events_[0].time);
  EXPECT_EQ(Vector3d(0.5, 0.5, 0.5), events_[0].position);
}

TEST_F(ZoneWatchTest, NoiseAtTheBorderMakesOneEventPerVisit) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> noise(-0.017, 0.017);
  // Less than the hysteresis from one corner of the noise to the other. The LED creeps in through
  // an edge, rests on the very border, creeps out; four such visits.
  for (int i = 0; i <= 7500; ++i) {
    const double inwards = 0.1 * std::sin(2.0 * M_PI * i / 2000.0);
    const double depth = std::abs(inwards) < 0.05 ? 0.0 : inwards - std::copysign(0.05, inwards);
    show(0.0025 * i, {led({1.0 - depth + noise(random), 1.0 - depth + noise(random), 0.5})});
  }
  // Without hysteresis there are hundreds.
  EXPECT_EQ("+box7 -box7 +box7 -box7 +box7 -box7 +box7 -box7", story());
}

TEST_F(ZoneWatchTest, LeavesBeyondTheHysteresisOnlyAndDatesItAtTheBorder) {
  show(0.0, {led({0.9, 0.5, 0.5})});
  show(1.0, {led({1.04, 0.5, 0.5})});  // out after 1/1.4 s, but not by more than 0.05 m
  show(2.0, {led({1.045, 0.5, 0.5})});
  EXPECT_EQ("+box7", story());
  show(3.0, {led({1.06, 0.5, 0.5})});
  ASSERT_EQ("+box7 -box7", story());
  EXPECT_NEAR(1.0 / 1.4, events_[1].time, 1e-12);
  EXPECT_LT((events_[1].position - Vector3d(1.0, 0.5, 0.5)).norm(), 1e-12);
}

TEST_F(ZoneWatchTest, ComingBackWithinTheHysteresisIsNotLeaving) {
  show(0.0, {led({0.9, 0.5, 0.5})});
  show(1.0, {led({1.04, 0.5, 0.5})});
  show(2.0, {led({0.9, 0.5, 0.5})});
  show(3.0, {led({1.1, 0.5, 0.5})});
  ASSERT_EQ("+box7 -box7", story());
  EXPECT_NEAR(2.5, events_[1].time, 1e-12) << "the last time through the border counts";
}

TEST_F(ZoneWatchTest, AThinZoneIsNotMissedBetweenTwoSnapshots) {
  watch_.setZones({{"gate", {0.0, 0.0, 0.0}, {0.001, 1.0, 1.0}}});
  show(0.0, {led({-0.5, 0.5, 0.5})});
  show(1.0, {led({0.5, 0.5, 0.5})});
  ASSERT_EQ("+gate7 -gate7", story());
  EXPECT_NEAR(0.5, events_[0].time, 1e-12);
  EXPECT_NEAR(0.501, events_[1].time, 1e-12);
  show(2.0, {led({-0.5, 2.5, 0.5})});  // past its end
  EXPECT_EQ(2u, events_.size());
}

TEST_F(ZoneWatchTest, ALedThatIsLostInsideHasLeft) {
  show(0.0, {led({0.5, 0.5, 0.5})});
  show(1.0, {led({0.6, 0.5, 0.5}, 7, TrackState::kPredicted)});
  EXPECT_EQ("+box7", story());
  show(1.5, {led({0.6, 0.5, 0.5}, 7, TrackState::kLost)});
  ASSERT_EQ("+box7 -box7", story());
  EXPECT_EQ(1.5, events_[1].time);
  EXPECT_EQ(Vector3d(0.6, 0.5, 0.5), events_[1].position);
  show(2.0, {led({0.6, 0.5, 0.5}, 8)});
  EXPECT_EQ("+box7 -box7 +box8", story());
}

TEST_F(ZoneWatchTest, ALedThatIsNoLongerShownHasLeftAfterTheTimeout) {
  show(0.0, {led({0.5, 0.5, 0.5})});
  show(1.0, {});
  EXPECT_EQ("+box7", story());
  show(1.001, {});
  ASSERT_EQ("+box7 -box7", story());
  EXPECT_EQ(1.001, events_[1].time);
  show(1.1, {});
  EXPECT_EQ(2u, events_.size());
}

TEST_F(ZoneWatchTest, TentativeLedsDoNotCount) {
  show(0.0, {led({0.5, 0.5, 0.5}, 7, TrackState::kTentative)});
  EXPECT_EQ("", story());
  show(0.1, {led({0.5, 0.5, 0.5})});
  EXPECT_EQ("+box7", story());
}

TEST_F(ZoneWatchTest, LedsAndZonesAreIndependent) {
  watch_.setZones({kBox, {"next", {1.0, 0.0, 0.0}, {2.0, 1.0, 1.0}}});
  show(0.0, {led({0.5, 0.5, 0.5}, 3), led({0.5, 5.0, 0.5}, 9)});
  show(1.0, {led({1.5, 0.5, 0.5}, 3), led({0.5, 0.5, 0.5}, 9)});
  // Both zones share a border, which is crossed once.
  EXPECT_EQ("+box3 -box3 +next3 +box9", story());
  show(2.0, {led({0.5, 0.5, 0.5}, 9)});
  show(2.5, {led({0.5, 0.5, 0.5}, 9)});
  EXPECT_EQ("+box3 -box3 +next3 +box9 -next3", story());
}

TEST_F(ZoneWatchTest, AfterAllAreLostTimeMayBeEarlier) {
  show(100.0, {led({0.5, 0.5, 0.5})});
  watch_.loseAll();
  show(1.0, {led({0.5, 0.5, 0.5}, 8)});
  ASSERT_EQ("+box7 -box7 +box8", story());
  EXPECT_EQ(1.0, events_[1].time);
}

TEST_F(ZoneWatchTest, UnchangedZonesKeepTheirState) {
  show(0.0, {led({0.5, 0.5, 0.5})});
  watch_.setZones({{"new", {0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}}, kBox});
  show(0.1, {led({0.5, 0.5, 0.5})});
  EXPECT_EQ("+box7 +new7", story()) << "already inside box";
  watch_.setZones({{"new", {3.0, 0.0, 0.0}, {4.0, 1.0, 1.0}}});
  show(0.2, {led({0.6, 0.5, 0.5})});
  ASSERT_EQ("+box7 +new7 -box7 -new7", story());
  EXPECT_EQ(0.2, events_[2].time);
  watch_.setZones({});
  show(0.3, {led({0.6, 0.5, 0.5})});
  EXPECT_EQ(4u, events_.size());
}

/// Every visit of a random walk to random boxes, compared with a watch that gets tiny steps.
TEST(ZoneWatch, AgreesWithFineSteps) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-1.0, 1.0);
  std::uniform_real_distribution<double> edge(0.1, 0.8);
  ZoneWatchOptions options;
  options.hysteresis = 0.0;
  options.timeout = 10.0;
  std::size_t compared = 0;
  for (int round = 0; round < 20; ++round) {
    std::vector<geometry::Zone> zones;
    for (int i = 0; i < 4; ++i) {
      const Vector3d corner(place(random), place(random), place(random));
      zones.push_back(
          {std::to_string(i), corner, corner + Vector3d(edge(random), edge(random), edge(random))});
    }
    ZoneWatch coarse(options);
    ZoneWatch fine(options);
    coarse.setZones(zones);
    fine.setZones(zones);
    std::vector<ZoneCrossing> seen;
    std::vector<ZoneCrossing> expected;
    const auto append = [](const auto& from, auto* to) {
      to->insert(to->end(), from.begin(), from.end());
    };
    Vector3d from(place(random), place(random), place(random));
    constexpr int kSteps = 300;
    for (int step = 0; step < 20; ++step) {
      const Vector3d to(place(random), place(random), place(random));
      append(coarse.update(snapshotAt(step + 1.0, {led(to)})), &seen);
      for (int i = step == 0 ? kSteps : 1; i <= kSteps; ++i) {
        const double share = static_cast<double>(i) / kSteps;
        append(fine.update(snapshotAt(step + share, {led(from + share * (to - from))})), &expected);
      }
      from = to;
    }
    ASSERT_EQ(expected.size(), seen.size());
    compared += seen.size();
    for (std::size_t i = 0; i < seen.size(); ++i) {
      EXPECT_EQ(expected[i].zone, seen[i].zone);
      EXPECT_EQ(expected[i].entered, seen[i].entered);
      EXPECT_NEAR(expected[i].time, seen[i].time, 1e-9);
      EXPECT_LT((expected[i].position - seen[i].position).norm(), 1e-9);
    }
  }
  EXPECT_GT(compared, 20u);
}

}  // namespace
}  // namespace wiimote_tracker::events
