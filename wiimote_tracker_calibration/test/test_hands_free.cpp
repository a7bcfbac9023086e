#include "capture/hands_free.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace wiimote_tracker::capture {
namespace {

constexpr double kFramePeriod = 0.01;  // [s]

/// Two cameras that see an LED; the second sees it shifted by 300 px.
class Hands : public ::testing::Test {
 protected:
  /// The LED goes from one place to another within `duration`. @returns how often it was noticed.
  int carry(const Eigen::Vector2d& from,
            const Eigen::Vector2d& to,
            double duration,
            double tremor = 0.0) {
    std::normal_distribution<double> noise(0.0, 0.4);
    int noticed = 0;
    for (const double end = now_ + duration, start = now_; now_ < end; now_ += kFramePeriod) {
      const double share = (now_ - start) / duration;
      const Eigen::Vector2d sway =
          tremor * Eigen::Vector2d(std::sin(7.0 * now_), std::cos(5.0 * now_));
      for (const char* camera : {"a", "b"}) {
        const Eigen::Vector2d offset(camera[0] == 'b' ? 300.0 : 0.0, 0.0);
        const Eigen::Vector2d error(noise(random_), noise(random_));
        const Eigen::Vector2d spot = from + share * (to - from) + sway + offset + error;
        if (hands_free_.add({camera, now_, 0, {spot}, {}}, captured_)) {
          ++noticed;
          hands_free_.restart();
          captured_.push_back({{"a", {spot - offset, 0.5, 50}},
                               {"b", {spot - offset + Eigen::Vector2d(300.0, 0.0), 0.5, 50}}});
        }
      }
    }
    return noticed;
  }
  int rest(const Eigen::Vector2d& place, double duration, double tremor = 0.0) {
    return carry(place, place, duration, tremor);
  }
  /// Nobody sees the LED.
  int hide(double duration) {
    int noticed = 0;
    for (const double end = now_ + duration; now_ < end; now_ += kFramePeriod) {
      for (const char* camera : {"a", "b"})
        noticed += hands_free_.add({camera, now_, 0, {}, {}}, captured_);
    }
    return noticed;
  }

  const Eigen::Vector2d first_{100.0, 200.0};
  const Eigen::Vector2d second_{500.0, 250.0};
  HandsFreeOptions options_;
  HandsFree hands_free_{{"a", "b"}, options_};
  std::vector<CapturedCorner> captured_;
  std::mt19937 random_{3};
  double now_ = 100.0;
};

TEST_F(Hands, AnLedPutDownIsNoticedOnce) {
  EXPECT_EQ(rest(first_, options_.hold - 0.1), 0);
  EXPECT_EQ(rest(first_, 0.2), 1);
  EXPECT_EQ(rest(first_, 20.0), 0);  // the same place again is no corner
}

TEST_F(Hands, AnLedIsNoticedAlsoWhenTimeJumpsBack) {
  EXPECT_EQ(rest(first_, 1.0), 0);
  now_ = 10.0;
  EXPECT_EQ(rest(first_, options_.hold + 1.0), 1);
}

TEST_F(Hands, ACameraWhoseClockIsBehindDoesNotPreventIt) {
  HandsFree hands_free({"a", "b", "behind"}, options_);
  int noticed = 0;
  for (int i = 0; i < 300; ++i, now_ += kFramePeriod) {
    for (const char* camera : {"a", "b"})
      noticed += hands_free.add({camera, now_, 0, {first_}, {}}, {});
    noticed += hands_free.add({"behind", now_ - 5.0, 0, {first_}, {}}, {});
  }
  EXPECT_GT(noticed, 0);
}

TEST_F(Hands, ACarriedLedIsNotStill) {
  EXPECT_EQ(rest(first_, 3.0), 1);
  EXPECT_EQ(carry(first_, second_, 8.0), 0);
  EXPECT_EQ(carry(second_, first_, 8.0), 0);
}

TEST_F(Hands, AnLedInAHandIsNotStill) {
  EXPECT_EQ(rest(first_, 30.0, 6.0), 0);
}

TEST_F(Hands, TheSamePlaceIsCapturedOnce) {
  EXPECT_EQ(rest(first_, 3.0), 1);
  EXPECT_EQ(carry(first_, second_, 2.0), 0);
  EXPECT_EQ(carry(second_, first_, 2.0), 0);
  EXPECT_EQ(rest(first_, 5.0), 0);
  EXPECT_EQ(hide(1.0), 0);
  EXPECT_EQ(rest(first_, 5.0), 0);
  EXPECT_EQ(carry(first_, second_, 2.0), 0);
  EXPECT_EQ(rest(second_, 5.0), 1);
}

TEST_F(Hands, ADropoutRestartsTheWait) {
  EXPECT_EQ(rest(first_, 1.5), 0);
  EXPECT_EQ(hide(1.0), 0);
  EXPECT_EQ(rest(first_, 1.5), 0);
  EXPECT_EQ(rest(first_, 0.6), 1);
  EXPECT_EQ(hide(10.0), 0);
}

TEST_F(Hands, AllCamerasThatSeeItMustSeeItStillAndEnoughOfThem) {
  int noticed = 0;
  for (int i = 0; i < 500; ++i, now_ += kFramePeriod) {
    noticed += hands_free_.add({"a", now_, 0, {first_}, {}}, {});
    noticed += hands_free_.add({"b", now_, 0, {{400.0 + i, 200.0}}, {}}, {});
  }
  EXPECT_EQ(noticed, 0);
  hands_free_.restart();
  for (int i = 0; i < 500; ++i, now_ += kFramePeriod) {
    noticed += hands_free_.add({"a", now_, 0, {first_}, {}}, {});
    noticed += hands_free_.add({"b", now_, 0, {first_, second_}, {}}, {});  // which one is it?
    noticed += hands_free_.add({"stranger", now_, 0, {first_}, {}}, {});
  }
  EXPECT_EQ(noticed, 0);
}

}  // namespace
}  // namespace wiimote_tracker::capture
