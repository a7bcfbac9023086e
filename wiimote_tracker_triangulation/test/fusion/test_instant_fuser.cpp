// One LED in front of unsynchronised cameras: where it is found, and what is refused.
#include "fusion/film.h"
#include "wiimote_tracker_triangulation/geometry/calibration_uncertainty.h"
#include "wiimote_tracker_triangulation/geometry/error.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace wiimote_tracker::fusion::test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::Rig;
using geometry::RigCamera;
using geometry::test::Random;
using tracking::CameraImage;
using tracking::Snapshot;
using tracking::SpotUse;
using tracking::TrackedLed;

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

TEST(InstantFuser, TheCovarianceContainsTheCalibrations) {
  Rig rig = threeCameras();
  InstantFuser exactly(rig, {});
  const TrackedLed known = *ledOf(fuse(exactly, film(rig, 100.0, 101.0, still)).back());
  rig.covariance = 1e-6 * Eigen::MatrixXd::Identity(48, 48);
  geometry::CalibrationUncertainty uncertainty(rig);
  const auto share =
      uncertainty.covarianceNear(known.position, known.cameras.data(), known.cameras.size());
  ASSERT_TRUE(share);
  EXPECT_GT(share->trace(), 0.0);
  InstantFuser uncertain(rig, {});
  const TrackedLed led = *ledOf(fuse(uncertain, film(rig, 100.0, 101.0, still)).back());
  EXPECT_LT((led.position_covariance - known.position_covariance - *share).norm(),
            1e-9 * share->norm());
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
  ASSERT_GT(instants.size(), 290u);
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
  ASSERT_GT(instants.size(), 140u);
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
  ASSERT_GT(instants.size(), 180u);
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
  EXPECT_EQ(1u, fuser.counters().dropped);
}

TEST(InstantFuser, ANewRigTakesEffectAtOnceAndTimeGoesOn) {
  const Rig rig = threeCameras();
  Rig moved = rig;
  for (RigCamera& camera : moved.cameras)
    camera.camera.world_from_camera.pretranslate(Vector3d(0.02, 0.0, 0.0));
  InstantFuser fuser(rig, {});
  const auto deliveries = film(rig, 100.0, 101.0, still);
  double newest = 0.0;
  int found_by_moved = 0;
  for (std::size_t i = 0; i < deliveries.size(); ++i) {
    if (i == 150) {
      fuser.setRig(moved);
      EXPECT_EQ(nullptr, fuser.next());
    }
    fuser.add(deliveries[i].camera, deliveries[i].image);
    while (const Snapshot* instant = fuser.next()) {
      EXPECT_GT(instant->time, newest);
      newest = instant->time;
      if (const TrackedLed* led = ledOf(*instant)) {
        const Vector3d expected = still(0) + Vector3d(i < 150 ? 0.0 : 0.02, 0.0, 0.0);
        EXPECT_LT((led->position - expected).norm(), 1e-9)
            << "not from old and new cameras together";
        EXPECT_EQ(0u, led->id);
        found_by_moved += i >= 150;
      }
    }
  }
  EXPECT_GT(found_by_moved, 130);
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
}  // namespace wiimote_tracker::fusion::test
