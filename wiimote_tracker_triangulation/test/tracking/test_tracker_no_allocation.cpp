// A warmed-up tracker takes images and gives snapshots without allocating.
#include "allocation_counter.h"
#include "tracking/tracker_runs.h"
#include "wiimote_tracker_triangulation/geometry/camera_parameters.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <optional>

namespace wiimote_tracker::tracking::test {
namespace {

TEST(TrackerNoAllocation, TheCounterCounts) {
  const int before = g_allocations;
  const auto something = std::make_unique<Eigen::MatrixXd>(9, 9);
  EXPECT_EQ(81, something->size());
  EXPECT_EQ(before + 2, g_allocations);
}

constexpr std::size_t kTurned = 1;  // camera

struct Situation {
  SceneOptions options;
  geometry::Rig rig = paperRig();          // as calibrated
  double turn = 0.0;                       // of a camera, since a quarter of the images [rad]
  std::optional<CameraFault::Kind> fault;  // of that camera in most images that count
};

/// Allocations in `count` images, after as many for warm-up.
int allocations(const Situation& situation, int count) {
  const SceneOptions& options = situation.options;
  geometry::Rig turned = situation.rig;
  turned.cameras[kTurned].camera.world_from_camera.rotate(
      Eigen::AngleAxisd(situation.turn, Eigen::Vector3d::UnitX()));
  const auto before_turn = imagesOf(situation.rig, wanderers(4, 3), options, 2 * count, 5);
  const auto after_turn = imagesOf(turned, wanderers(4, 3), options, 2 * count, 5);
  TrackerOptions tracker_options;
  tracker_options.pixel_stddev = options.pixel_noise;
  Tracker tracker(situation.rig, tracker_options);
  const std::size_t first = before_turn.size() / 2;  // that counts
  int before = 0;
  Snapshot predicted;
  std::size_t leds_seen = 0;
  std::size_t merged = 0;    // spots in the images that count
  std::size_t as_named = 0;  // of these images, those with the expected fault or none
  for (std::size_t i = 0; i < 2 * first; ++i) {
    const SceneImage& image = i < first / 2 ? before_turn[i] : after_turn[i];
    if (i == first)
      before = g_allocations;
    for (const std::uint64_t leds : image.leds_of_spot)
      merged += i >= first && (leds & (leds - 1)) != 0;
    tracker.add(image.camera, image.image);
    while (const Snapshot* snapshot = tracker.next())
      leds_seen += snapshot->leds.size();
    tracker.predictTo(image.image.stamp + 0.1, &predicted);
    const std::optional<CameraFault> fault = tracker.cameraFault(kTurned);
    as_named += i >= first && (fault ? fault->kind == situation.fault : !situation.fault);
  }
  const int result = g_allocations - before;
  EXPECT_GT(leds_seen, 4 * first);
  EXPECT_GT(as_named, 0.9 * first);
  EXPECT_EQ(options.merging_distance > 0.0, merged > 0);
  EXPECT_EQ(options.delay_jitter > 0.0, tracker.counters().late > 0);
  return result;
}

/// The orientations of the rig's cameras are known to this standard deviation [rad].
void makeVague(double stddev, geometry::Rig* rig) {
  const auto parameters = geometry::firstParameter(rig->cameras.size());
  rig->covariance.setZero(parameters, parameters);
  for (std::size_t i = 0; i < rig->cameras.size(); ++i) {
    const auto turn = geometry::firstParameter(i) + geometry::kRotation;
    rig->covariance.diagonal().segment<3>(turn).fill(stddev * stddev);
  }
}

TEST(TrackerNoAllocation, ImagesInOrder) {
  EXPECT_EQ(0, allocations({}, 1000));
}

TEST(TrackerNoAllocation, MergedSpots) {
  Situation situation;
  situation.options.merging_distance = 24.0;
  EXPECT_EQ(0, allocations(situation, 4000));
}

TEST(TrackerNoAllocation, LateImages) {
  Situation situation;
  situation.options.delay_jitter = 0.003;
  EXPECT_EQ(0, allocations(situation, 1000));
}

TEST(TrackerNoAllocation, CovarianceOfTheCalibration) {
  Situation situation;
  makeVague(1e-3, &situation.rig);
  EXPECT_EQ(0, allocations(situation, 1000));
}

TEST(TrackerNoAllocation, CovarianceOfRaysThroughTheImageCenter) {
  Situation situation;
  geometry::Rig& rig = situation.rig;
  rig.ray_model = geometry::RayModel::kImageCenter;
  for (geometry::RigCamera& camera : rig.cameras) {
    camera.camera.identity = "00:00:00:00:00:00";  // a copy of it would allocate
    geometry::Intrinsics& lens = camera.camera.intrinsics;
    lens.cx = 0.5 * lens.width;
    lens.cy = 0.5 * lens.height;
    lens.distortion = {};
  }
  makeVague(1e-3, &rig);
  EXPECT_EQ(0, allocations(situation, 1000));
}

TEST(TrackerNoAllocation, AKnockedCamera) {
  Situation situation;
  situation.turn = 0.035;
  situation.fault = CameraFault::Kind::kMisfit;
  EXPECT_EQ(0, allocations(situation, 2000));
}

TEST(TrackerNoAllocation, AnInaccurateCamera) {
  Situation situation;
  situation.turn = 0.0175;  // moves spots by 23 px; the standard deviation is 13 px
  situation.fault = CameraFault::Kind::kInaccurate;
  makeVague(0.01, &situation.rig);
  EXPECT_EQ(0, allocations(situation, 2000));
}

}  // namespace
}  // namespace wiimote_tracker::tracking::test
