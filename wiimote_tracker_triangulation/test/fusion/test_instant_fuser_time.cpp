// Cameras that lose sight of an LED, fail and come back; images out of order, and time that jumps.
#include "fusion/film.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace wiimote_tracker::fusion::test {
namespace {

using geometry::Rig;
using geometry::RigCamera;
using geometry::test::Random;
using tracking::Snapshot;

void expectIdentical(const std::vector<Snapshot>& a, const std::vector<Snapshot>& b) {
  ASSERT_FALSE(a.empty());
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].time, b[i].time);
    ASSERT_EQ(a[i].latest_arrival, b[i].latest_arrival);
    ASSERT_EQ(a[i].skew, b[i].skew);
    ASSERT_EQ(a[i].leds.size(), b[i].leds.size());
    for (std::size_t l = 0; l < a[i].leds.size(); ++l) {
      ASSERT_EQ(a[i].leds[l].cameras, b[i].leds[l].cameras);
      ASSERT_EQ(a[i].leds[l].position, b[i].leds[l].position);
      ASSERT_EQ(a[i].leds[l].position_covariance, b[i].leds[l].position_covariance);
    }
  }
}

TEST(InstantFuser, ACameraWithoutSpotsDoesNotStopTheOthers) {
  const Rig rig = threeCameras();
  InstantFuser fuser(rig, {});
  std::vector<Delivery> deliveries = film(rig, 100.0, 101.0, still);
  for (Delivery& d : deliveries) {
    if (d.camera == 1)
      d.image.spots.clear();
  }
  const auto instants = fuse(fuser, deliveries);
  EXPECT_GT(instants.size(), 290u);
  for (std::size_t i = 10; i < instants.size(); ++i) {
    ASSERT_TRUE(ledOf(instants[i]));
    EXPECT_EQ(2u, ledOf(instants[i])->cameras.size());
    EXPECT_EQ(3u, ledOf(instants[i])->rays_possible);
    EXPECT_FALSE(uses(*ledOf(instants[i]), 1));
    EXPECT_LT((ledOf(instants[i])->position - still(0)).norm(), 1e-9);
  }
}

TEST(InstantFuser, ReportsWhenNothingIsSeen) {
  const Rig rig = threeCameras();
  InstantFuser fuser(rig, {});
  std::vector<Delivery> deliveries = film(rig, 100.0, 100.2, still);
  for (Delivery& d : deliveries)
    d.image.spots.clear();
  const auto instants = fuse(fuser, deliveries);
  EXPECT_GT(instants.size(), 50u);
  for (const Snapshot& instant : instants)
    EXPECT_FALSE(ledOf(instant));
}

TEST(InstantFuser, NeverReportsAnOldPointAsNew) {
  const Rig rig = threeCameras();
  InstantFuser fuser(rig, {});
  std::vector<Delivery> deliveries = film(rig, 100.0, 101.0, still);
  for (Delivery& d : deliveries) {
    if (d.image.stamp >= 100.5)
      d.image.spots.clear();
  }
  int seen = 0;
  int after = 0;
  for (const Snapshot& instant : fuse(fuser, deliveries)) {
    EXPECT_FALSE(ledOf(instant) && instant.time >= 100.5);
    seen += ledOf(instant) != nullptr;
    after += instant.time >= 100.5;
  }
  EXPECT_GT(seen, 130);
  EXPECT_GT(after, 140);
}

TEST(InstantFuser, AFailedCameraDelaysOnceByItsTimeoutAndIsUsedAgain) {
  const Rig rig = threeCameras();
  InstantFuser fuser(rig, {});
  const auto all = film(rig, 100.0, 102.0, circle);
  std::vector<Delivery> deliveries;
  for (const Delivery& d : all) {
    const bool dead = d.camera == 0 && d.image.stamp > 100.5 && d.image.stamp < 101.5;
    if (!dead)
      deliveries.push_back(d);
  }
  double longest_wait = 0.0;
  double longest_wait_later = 0.0;
  int without = 0;
  int again = 0;
  for (const Delivery& d : deliveries) {
    fuser.add(d.camera, d.image);
    while (const Snapshot* instant = fuser.next()) {
      const double wait = d.image.arrival - (instant->time + kLatency);
      longest_wait = std::max(longest_wait, wait);
      if (instant->time > 100.7)
        longest_wait_later = std::max(longest_wait_later, wait);
      if (instant->time > 100.52 && instant->time < 101.49) {
        ASSERT_TRUE(ledOf(*instant));
        EXPECT_EQ(2u, ledOf(*instant)->cameras.size());
        EXPECT_EQ(3u, ledOf(*instant)->rays_possible);
        ++without;
      }
      if (instant->time > 101.52) {
        ASSERT_TRUE(ledOf(*instant));
        EXPECT_EQ(3u, ledOf(*instant)->cameras.size());
        ++again;
      }
      if (ledOf(*instant)) {
        EXPECT_LT((ledOf(*instant)->position - circle(instant->time)).norm(), 1e-4);
      }
    }
  }
  EXPECT_LT(longest_wait, InstantFuserOptions().camera_timeout + kPeriod);
  EXPECT_LE(longest_wait_later, kPeriod + 1e-9);
  EXPECT_GT(without, 180);
  EXPECT_GT(again, 130);
}

TEST(InstantFuser, ACameraWithoutImagesDelaysTheStartOnly) {
  const Rig rig = threeCameras();
  InstantFuser fuser(rig, {});
  std::vector<Delivery> deliveries;
  for (const Delivery& d : film(rig, 100.0, 101.0, still)) {
    if (d.camera != 2)
      deliveries.push_back(d);
  }
  const auto instants = fuse(fuser, deliveries);
  EXPECT_GT(instants.size(), 190u);
  EXPECT_NEAR(instants.front().time, 100.001, 1e-9) << "nothing is lost by waiting";
}

TEST(InstantFuser, DoesNotInterpolateAcrossALongGap) {
  const Rig rig = threeCameras();
  InstantFuser fuser(rig, {});
  std::vector<Delivery> deliveries;
  for (Delivery& d : film(rig, 100.0, 101.0, circle)) {
    d.image.maximum_spots = 1;
    // 80 ms: longer than maximum_gap, shorter than camera_timeout.
    if (!(d.camera == 0 && d.image.stamp > 100.5 && d.image.stamp < 100.58))
      deliveries.push_back(d);
  }
  int inside = 0;
  for (const Snapshot& instant : fuse(fuser, deliveries)) {
    if (instant.time > 100.502 && instant.time < 100.579) {
      EXPECT_TRUE(instant.views[0].spots.empty());
      EXPECT_FALSE(instant.views[0].full);
      EXPECT_TRUE(ledOf(instant));
      ++inside;
    }
  }
  EXPECT_GT(inside, 10);
}

TEST(InstantFuser, CountsAndIgnoresImagesThatComeLateOrTwice) {
  const Rig rig = threeCameras();
  InstantFuser clean(rig, {});
  InstantFuser disturbed(rig, {});
  const auto deliveries = film(rig, 100.0, 101.0, circle);
  std::vector<Delivery> with_repeats;
  for (std::size_t i = 0; i < deliveries.size(); ++i) {
    with_repeats.push_back(deliveries[i]);
    if (i % 10 == 5) {
      with_repeats.push_back(deliveries[i]);  // twice
      Delivery old = deliveries[i];           // out of order, with other content
      old.image.stamp -= 0.5 * kPeriod;
      old.image.spots = {spotAt({1.0, 1.0})};
      with_repeats.push_back(old);
    }
  }
  expectIdentical(fuse(clean, deliveries), fuse(disturbed, with_repeats));
  EXPECT_EQ(0u, lateImages(clean));
  EXPECT_EQ(with_repeats.size() - deliveries.size(), lateImages(disturbed));
}

TEST(InstantFuser, ACameraThatRepeatsItsLastImageMakesNoInstant) {
  const Rig rig = threeCameras();
  InstantFuser fuser(rig, {});
  const auto deliveries = film(rig, 100.0, 101.0, still);
  auto instants = fuse(fuser, deliveries);
  Delivery stuck = deliveries.back();
  stuck.image.arrival += 1.0;
  // Only the other cameras' last images are instants now, as they are not waited for any more.
  for (const Snapshot& instant : fuse(fuser, {stuck, stuck}))
    instants.push_back(instant);
  expectIncreasing(instants);
  EXPECT_EQ(deliveries.size(), instants.size());
  EXPECT_EQ(2u, fuser.counters().repeated);
  EXPECT_GT(fuse(fuser, film(rig, 103.0, 104.0, still)).size(), 290u);
}

TEST(InstantFuser, StartsOverWhenTimeJumpsBack) {
  const Rig rig = threeCameras();
  InstantFuserOptions options;
  options.maximum_leds = 1;  // so that an LED which is not forgotten leaves no place for another
  InstantFuser fuser(rig, options);
  const auto first = fuse(fuser, film(rig, 100.0, 102.0, circle));
  const auto second = fuse(fuser, film(rig, 100.0, 102.0, circle));
  EXPECT_EQ(1u, fuser.counters().resets);
  EXPECT_EQ(0u, lateImages(fuser));
  expectIdentical(first, second);
}

/// As when another bag is played, whose rig was calibrated anew.
TEST(InstantFuser, StartsOverWhenANewRigComesWithAnEarlierTime) {
  const Rig rig = threeCameras();
  InstantFuser fuser(rig, {});
  const auto first = fuse(fuser, film(rig, 100.0, 102.0, circle));
  fuser.setRig(rig);
  const auto second = fuse(fuser, film(rig, 100.0, 102.0, circle));
  EXPECT_EQ(1u, fuser.counters().resets);
  expectIdentical(first, second);
}

TEST(InstantFuser, DoesNotStartOverForASmallStepBack) {
  const Rig rig = threeCameras();
  InstantFuser fuser(rig, {});
  fuse(fuser, film(rig, 100.0, 100.5, circle));
  fuse(fuser, film(rig, 100.0, 100.4, circle));
  EXPECT_EQ(0u, fuser.counters().resets);
  EXPECT_EQ(120u, lateImages(fuser));
}

/// A random order that keeps each camera's images in order; no image is overtaken by one that
/// arrived more than `most` later.
std::vector<Delivery> shuffled(std::vector<Delivery> rest, double most, Random& random) {
  std::vector<Delivery> result;
  while (!rest.empty()) {
    const double deadline = rest.front().image.arrival + most;  // rest stays sorted by arrival
    std::vector<std::size_t> candidates;
    std::vector<bool> camera_taken(16, false);
    for (std::size_t i = 0; i < rest.size() && rest[i].image.arrival < deadline; ++i) {
      if (!camera_taken[rest[i].camera])
        candidates.push_back(i);
      camera_taken[rest[i].camera] = true;
    }
    const auto pick = candidates[static_cast<std::size_t>(random.uniform(0, candidates.size()))];
    result.push_back(rest[pick]);
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(pick));
  }
  return result;
}

TEST(InstantFuser, TheOrderOfCallbacksBetweenCamerasDoesNotMatter) {
  const Rig rig = threeCameras();
  Random random(52);
  auto deliveries = film(rig, 100.0, 101.0, circle);
  for (Delivery& d : deliveries) {
    if (random.uniform(0, 1) < 0.1)
      d.image.spots.clear();
  }
  InstantFuser reference(rig, {});
  const auto expected = fuse(reference, deliveries);
  for (int i = 0; i < 30; ++i) {
    InstantFuser fuser(rig, {});
    const auto mixed = shuffled(deliveries, 0.09, random);
    auto instants = fuse(fuser, mixed);
    EXPECT_EQ(0u, lateImages(fuser));
    // The last instants depend on the last image; by then both have received the same images.
    expectIdentical(expected, instants);
  }
}

TEST(InstantFuser, AppliesTimeOffsetsByTheirRule) {
  Rig rig = threeCameras();
  // The cameras' clocks are off; their images carry wrong stamps that the rig's offsets correct.
  const double offsets[] = {0.004, -0.003, 0.002};
  for (std::size_t c = 0; c < 3; ++c) {
    rig.cameras[c].time_offset = offsets[c];
    rig.cameras[c].time_offset_rule = geometry::TimeOffsetRule::kAlways;
  }
  rig.cameras[2].time_offset_rule = geometry::TimeOffsetRule::kOneEpoch;
  rig.cameras[2].time_offset_epoch = 7;
  auto deliveries = film(rig, 100.0, 101.0, circle);
  for (Delivery& d : deliveries) {
    d.image.stamp -= offsets[d.camera];
    d.image.clock_epoch = 7;
  }
  const auto worstError = [&](const Rig& used) {
    InstantFuser fuser(used, {});
    double worst = 0.0;
    int found = 0;
    for (const Snapshot& instant : fuse(fuser, deliveries)) {
      if (!ledOf(instant) || ledOf(instant)->cameras.size() < 3)
        continue;
      worst = std::max(worst, (ledOf(instant)->position - circle(instant.time)).norm());
      ++found;
    }
    EXPECT_GT(found, 190);
    return worst;
  };
  EXPECT_LT(worstError(rig), 5e-5);
  Rig other_epoch = rig;
  other_epoch.cameras[2].time_offset_epoch = 8;  // since then the driver was started again
  EXPECT_LT(worstError(other_epoch), 5e-5);
  other_epoch.cameras[2].time_offset_epoch = 6;
  EXPECT_GT(worstError(other_epoch), 5e-4);
  for (RigCamera& camera : other_epoch.cameras)
    camera.time_offset_rule = geometry::TimeOffsetRule::kNone;
  EXPECT_GT(worstError(other_epoch), 1e-3);
}
}  // namespace
}  // namespace wiimote_tracker::fusion::test
