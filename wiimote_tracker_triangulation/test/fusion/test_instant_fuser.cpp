// One LED in front of unsynchronised cameras that lose sight of it, fail and come back.
#include "fusion/film.h"
#include "geometry/random_rigs.h"
#include "wiimote_tracker_triangulation/geometry/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace wiimote_tracker::fusion {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::Rig;
using geometry::RigCamera;
using geometry::test::Random;
using test::Delivery;
using test::film;
using test::fuse;
using test::kLatency;
using test::kPeriod;
using test::ledOf;
using test::spotAt;
using test::still;
using tracking::CameraImage;
using tracking::Snapshot;
using tracking::SpotUse;
using tracking::TrackedLed;

Rig threeCameras() {
  Random random(51);
  return geometry::test::randomRig(random, 3);
}

bool uses(const TrackedLed& led, std::size_t camera) {
  return std::count(led.cameras.begin(), led.cameras.end(), camera) > 0;
}

void expectIncreasing(const std::vector<Snapshot>& instants) {
  for (std::size_t i = 1; i < instants.size(); ++i)
    ASSERT_GT(instants[i].time, instants[i - 1].time);
}

void expectIdentical(const std::vector<Snapshot>& a, const std::vector<Snapshot>& b) {
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

std::uint64_t lateImages(const InstantFuser& fuser) {
  return fuser.counters().late + fuser.counters().repeated;
}

/// 1 m/s on a circle of 0.5 m.
Vector3d circle(double t) {
  return {0.5 * std::cos(2.0 * t), 0.5 * std::sin(2.0 * t), 0.2};
}

TEST(InstantFuser, FindsALedAtRest) {
  const Rig rig = threeCameras();
  InstantFuser fuser(rig, {});
  const auto instants = fuse(fuser, film(rig, 100.0, 101.0, still));
  EXPECT_GT(instants.size(), 290u) << "every image is an instant";
  expectIncreasing(instants);
  int complete = 0;
  for (const Snapshot& instant : instants) {
    if (!ledOf(instant))
      continue;
    EXPECT_LT((ledOf(instant)->position - still(0)).norm(), 1e-9);
    complete += ledOf(instant)->cameras.size() == 3;
    EXPECT_EQ(3u, ledOf(instant)->rays_possible);
  }
  EXPECT_GT(complete, 290);
  EXPECT_EQ(0u, lateImages(fuser));
}

TEST(InstantFuser, InterpolationIsExactForPixelsThatMoveLinearly) {
  const Rig rig = threeCameras();
  InstantFuser fuser(rig, {});
  // Start and velocity of each camera's pixel.
  const auto pixel = [&](std::size_t c, double t) {
    return Vector2d(*rig.cameras[c].camera.project(still(0)) +
                    (t - 100.0) * Vector2d(3.0 + c, -7.0 + 2.0 * c));
  };
  std::vector<Delivery> deliveries = film(rig, 100.0, 100.5, still);
  for (Delivery& d : deliveries)
    d.image.spots = {spotAt(pixel(d.camera, d.image.stamp))};
  int compared = 0;
  for (const Snapshot& instant : fuse(fuser, deliveries)) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (instant.views[c].spots.empty())
        continue;
      EXPECT_LT((instant.views[c].spots[0].pixel - pixel(c, instant.time)).norm(), 1e-9);
      ++compared;
    }
  }
  EXPECT_GT(compared, 430);
}

TEST(InstantFuser, FollowsALedThatMoves) {
  // Between two images the path bends by v^2 / r * dt^2 / 8 = 25 um at most.
  const Rig rig = threeCameras();
  InstantFuser fuser(rig, {});
  int found = 0;
  for (const Snapshot& instant : fuse(fuser, film(rig, 100.0, 101.0, circle))) {
    if (!ledOf(instant) || ledOf(instant)->cameras.size() < 3)
      continue;
    EXPECT_LT((ledOf(instant)->position - circle(instant.time)).norm(), 5e-5);
    ++found;
  }
  EXPECT_GT(found, 290);
}

TEST(InstantFuser, SaysHowOldAndHowFarApartItsImagesAre) {
  const Rig rig = threeCameras();
  InstantFuser fuser(rig, {});
  const auto instants = fuse(fuser, film(rig, 100.0, 101.0, still));
  for (std::size_t i = 20; i < instants.size(); ++i) {
    const Snapshot& instant = instants[i];
    // The third camera's bracket reaches furthest: 7 or 4 ms to one side.
    EXPECT_NEAR(instant.skew, 0.007, 1e-6);
    EXPECT_NEAR(ledOf(instant)->last_observed, instant.time, 1e-9)
        << "the image of this time shows it";
    EXPECT_GE(instant.latest_arrival, instant.time + kLatency);
    EXPECT_LE(instant.latest_arrival, instant.time + kLatency + kPeriod);
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
  for (const Snapshot& instant : fuse(fuser, deliveries))
    EXPECT_FALSE(ledOf(instant) && instant.time >= 100.5);
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
  for (const Delivery& d : film(rig, 100.0, 101.0, circle)) {
    // 80 ms: longer than maximum_gap, shorter than camera_timeout.
    if (!(d.camera == 0 && d.image.stamp > 100.5 && d.image.stamp < 100.58))
      deliveries.push_back(d);
  }
  int inside = 0;
  for (const Snapshot& instant : fuse(fuser, deliveries)) {
    if (instant.time > 100.502 && instant.time < 100.579) {
      EXPECT_TRUE(instant.views[0].spots.empty());
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

TEST(InstantFuser, StartsOverWhenTimeJumpsBack) {
  const Rig rig = threeCameras();
  InstantFuser fuser(rig, {});
  const auto first = fuse(fuser, film(rig, 100.0, 102.0, circle));
  const auto second = fuse(fuser, film(rig, 100.0, 102.0, circle));
  EXPECT_EQ(1u, fuser.counters().resets);
  EXPECT_EQ(0u, lateImages(fuser));
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
  other_epoch.cameras[2].time_offset_epoch = 8;
  EXPECT_GT(worstError(other_epoch), 5e-4);
  for (RigCamera& camera : other_epoch.cameras)
    camera.time_offset_rule = geometry::TimeOffsetRule::kNone;
  EXPECT_GT(worstError(other_epoch), 1e-3);
}

TEST(InstantFuser, LampsAreIgnored) {
  Rig rig = threeCameras();
  rig.cameras[0].masks = {{Vector2d(5.0, 5.0), 3.0}};
  auto deliveries = film(rig, 100.0, 100.5, still);
  for (Delivery& d : deliveries) {
    if (d.camera == 0)
      d.image.spots.insert(d.image.spots.begin(), spotAt({6.0, 6.0}));  // masked lamp
    if (d.camera == 1)
      d.image.spots.push_back(spotAt({6.0, 6.0}));  // unmasked lamp
  }
  InstantFuser fuser(rig, {});
  const auto instants = fuse(fuser, deliveries);
  for (std::size_t i = 10; i < instants.size(); ++i) {
    ASSERT_TRUE(ledOf(instants[i]));
    EXPECT_TRUE(uses(*ledOf(instants[i]), 0));
    EXPECT_TRUE(uses(*ledOf(instants[i]), 1));
    EXPECT_TRUE(uses(*ledOf(instants[i]), 2));
    EXPECT_EQ(1u, instants[i].leds.size());
    const auto& masked = instants[i].views[0].spots;
    ASSERT_EQ(2u, masked.size());
    EXPECT_EQ(SpotUse::kAssigned, masked[0].use);
    EXPECT_EQ(ledOf(instants[i])->id, masked[0].led);
    EXPECT_EQ(SpotUse::kMasked, masked[1].use);
    EXPECT_EQ(Vector2d(6.0, 6.0), masked[1].pixel);
    EXPECT_EQ(SpotUse::kUnassigned, instants[i].views[1].spots[1].use);
    EXPECT_LT((ledOf(instants[i])->position - still(0)).norm(), 1e-9);
  }
}

TEST(InstantFuser, DropsTheOneCameraThatSeesSomethingElse) {
  Random random(53);
  const Rig rig = geometry::test::randomRig(random, 4);
  auto deliveries = film(rig, 100.0, 100.5, still);
  for (Delivery& d : deliveries) {
    if (d.camera == 2)
      d.image.spots[0].pixel += Vector2d(150.0, -120.0);
  }
  InstantFuser fuser(rig, {});
  const auto instants = fuse(fuser, deliveries);
  for (std::size_t i = 10; i < instants.size(); ++i) {
    ASSERT_TRUE(ledOf(instants[i]));
    EXPECT_EQ(3u, ledOf(instants[i])->cameras.size());
    EXPECT_FALSE(uses(*ledOf(instants[i]), 2));
    EXPECT_LT((ledOf(instants[i])->position - still(0)).norm(), 1e-9);
  }
}

TEST(InstantFuser, TwoCamerasThatDisagreeGiveNoPoint) {
  Rig rig = threeCameras();
  rig.cameras.pop_back();
  auto deliveries = film(rig, 100.0, 100.5, still);
  for (Delivery& d : deliveries) {
    if (d.camera == 1)
      d.image.spots[0].pixel += Vector2d(100.0, 100.0);
  }
  InstantFuser fuser(rig, {});
  const auto instants = fuse(fuser, deliveries);
  EXPECT_GT(instants.size(), 90u);
  for (const Snapshot& instant : instants)
    EXPECT_FALSE(ledOf(instant));
}

TEST(InstantFuser, OneCameraGivesNoPoint) {
  Rig rig = threeCameras();
  rig.cameras.resize(1);
  InstantFuser fuser(rig, {});
  const auto instants = fuse(fuser, film(rig, 100.0, 100.2, still));
  EXPECT_GT(instants.size(), 15u);
  for (const Snapshot& instant : instants)
    EXPECT_FALSE(ledOf(instant));
}

TEST(InstantFuser, ImagesWithoutATimeAreIgnored) {
  const Rig rig = threeCameras();
  InstantFuser fuser(rig, {});
  CameraImage image;
  image.stamp = std::numeric_limits<double>::quiet_NaN();
  fuser.add(0, image);
  EXPECT_EQ(nullptr, fuser.next());
}

TEST(InstantFuser, ANewRigTakesEffectAtOnceAndTimeGoesOn) {
  const Rig rig = threeCameras();
  Rig moved = rig;
  for (RigCamera& camera : moved.cameras)
    camera.camera.world_from_camera.pretranslate(Vector3d(0.02, 0.0, 0.0));
  InstantFuser fuser(rig, {});
  const auto deliveries = film(rig, 100.0, 101.0, still);
  double newest = 0.0;
  for (std::size_t i = 0; i < deliveries.size(); ++i) {
    if (i == 150)
      fuser.setRig(moved);
    fuser.add(deliveries[i].camera, deliveries[i].image);
    while (const Snapshot* instant = fuser.next()) {
      EXPECT_GT(instant->time, newest);
      newest = instant->time;
      if (const TrackedLed* led = ledOf(*instant)) {
        const Vector3d expected = still(0) + Vector3d(i < 150 ? 0.0 : 0.02, 0.0, 0.0);
        EXPECT_LT((led->position - expected).norm(), 1e-9)
            << "not from old and new cameras together";
        EXPECT_EQ(0u, led->id);
      }
    }
  }
  EXPECT_GT(newest, 100.97);
}

TEST(InstantFuser, AnUnusableRigIsRefusedAndTheOneBeforeStays) {
  const Rig rig = threeCameras();
  InstantFuser fuser(rig, {});
  auto deliveries = film(rig, 100.0, 100.5, still);
  fuse(fuser, {deliveries.begin(), deliveries.begin() + 60});
  Rig unusable = rig;
  unusable.cameras[1].camera.intrinsics.fx = -1.0;
  EXPECT_THROW(fuser.setRig(unusable), geometry::InvalidRigError);
  const auto instants = fuse(fuser, {deliveries.begin() + 60, deliveries.end()});
  EXPECT_GT(instants.size(), 80u);
  for (const Snapshot& instant : instants)
    EXPECT_TRUE(ledOf(instant));
}

}  // namespace
}  // namespace wiimote_tracker::fusion
