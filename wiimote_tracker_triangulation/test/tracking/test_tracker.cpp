// Track initiation, accuracy and reports.
#include "geometry/accuracy.h"
#include "tracking/tracker_runs.h"
#include "wiimote_tracker_triangulation/estimators/make_estimator.h"
#include "wiimote_tracker_triangulation/geometry/calibration_uncertainty.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <vector>

namespace wiimote_tracker::tracking::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Tracker, FourLedsAreFoundAndKept) {
  const std::vector<Path> leds = wanderers(4, 5);
  SceneOptions options;
  options.dropout = 0.1;
  options.ghosts = 1.0;
  options.merging_distance = 8.0;
  Tracker tracker(paperRig(), exactOptions());
  IdentityCheck check(leds);
  for (const Snapshot& snapshot : track(&tracker, imagesOf(paperRig(), leds, options, 4000))) {
    if (snapshot.time > options.start + 0.5)
      check.add(snapshot);
  }
  EXPECT_EQ(0u, check.switches);
  EXPECT_EQ(0u, check.renamed);
  EXPECT_EQ(0u, check.uncovered);
  EXPECT_EQ(0u, check.false_tracks);
  EXPECT_GT(check.snapshots, 3700u);
}

TEST(Tracker, AStillLedIsLocatedBetterThanByOneImageOfEachCamera) {
  const geometry::Rig rig = paperRig();
  const Eigen::Vector3d place(1.1, 1.4, 0.9);
  Tracker tracker(rig, exactOptions());
  double squares = 0.0;
  int count = 0;
  for (const Snapshot& s : track(&tracker, imagesOf(rig, {still(place)}, SceneOptions(), 2000))) {
    if (s.time < 1002.0)
      continue;
    ASSERT_EQ(1u, s.leds.size());
    const TrackedLed& led = s.leds[0];
    EXPECT_EQ(TrackState::kTracked, led.state);
    EXPECT_EQ(4u, led.cameras.size());
    EXPECT_EQ(4u, led.rays_possible);
    EXPECT_LT((led.position - place).norm(), 6.0 * std::sqrt(led.position_covariance.trace()));
    squares += (led.position - place).squaredNorm();
    ++count;
  }
  std::vector<geometry::Observation> observations;
  for (const geometry::RigCamera& camera : rig.cameras)
    observations.push_back({&camera.camera, *camera.camera.project(place)});
  geometry::TriangulationOptions options;
  options.pixel_stddev = 0.3;
  const auto once = geometry::triangulate(observations, options);
  ASSERT_GT(count, 1000);
  EXPECT_LT(squares / count, once->covariance.trace());
}

TEST(Tracker, LightsSeenBySingleCamerasAreNoLeds) {
  SceneOptions options;
  options.reflections = {{{100.0, 700.0}, {700.0, 60.0}}, {{900.0, 40.0}}, {}, {{60.0, 60.0}}};
  options.ghosts = 1.0;
  Tracker tracker(paperRig(), exactOptions());
  const std::vector<Snapshot> snapshots = track(&tracker, imagesOf(paperRig(), {}, options, 4000));
  EXPECT_GT(snapshots.size(), 3900u);
  for (const Snapshot& snapshot : snapshots)
    EXPECT_TRUE(idsIn(snapshot, TrackState::kTracked).empty()) << snapshot.time;
}

TEST(Tracker, ABoxExcludesMirroredLights) {
  const std::vector<Path> leds = {still({1.25, 1.25, 0.3}), still({1.25, 1.25, -0.3})};
  const auto images = imagesOf(paperRig(), leds, {}, 400);
  Tracker open(paperRig(), exactOptions());
  EXPECT_EQ(2u, track(&open, images).back().leds.size());
  TrackerOptions options = exactOptions();
  options.minimum_corner = {-10.0, -10.0, 0.0};
  Tracker closed(paperRig(), options);
  const Snapshot last = track(&closed, images).back();
  ASSERT_EQ(1u, last.leds.size());
  EXPECT_GT(last.leds[0].position.z(), 0.0);
  options = exactOptions();
  options.maximum_corner = {10.0, 10.0, 0.0};
  Tracker below(paperRig(), options);
  const Snapshot last_below = track(&below, images).back();
  ASSERT_EQ(1u, last_below.leds.size());
  EXPECT_LT(last_below.leds[0].position.z(), 0.0);
}

TEST(Tracker, MoreLightsThanACameraReports) {
  // The two nearest of three win in each view, so that each LED is seen by two of them or more.
  const std::vector<Path> leds = {still({0.6, 0.6, 0.9}), still({1.9, 0.7, 1.0}),
                                  still({1.3, 1.9, 1.1})};
  SceneOptions options;
  options.maximum_spots = 2;
  Tracker tracker(paperRig(), exactOptions());
  IdentityCheck check(leds);
  for (const Snapshot& snapshot : track(&tracker, imagesOf(paperRig(), leds, options, 1200))) {
    if (snapshot.time > 1000.5)
      check.add(snapshot);
  }
  EXPECT_EQ(0u, check.uncovered);
  EXPECT_EQ(0u, check.renamed);
}

TEST(Tracker, FortyCamerasInOneRoom) {
  const std::vector<Path> leds = {circle({0.4, 0.3, 1.0}, 0.3, 0.6),
                                  circle({-0.4, -0.3, 1.1}, 0.3, 0.6)};
  const geometry::Rig rig = roomsRig(1, 40);
  SceneOptions options;
  options.delay_jitter = 0.0024;
  Tracker tracker(rig, exactOptions());
  IdentityCheck check(leds);
  std::size_t cameras = 40;
  for (const Snapshot& snapshot : track(&tracker, imagesOf(rig, leds, options, 4000))) {
    if (snapshot.time < 1000.3)
      continue;
    check.add(snapshot);
    for (const TrackedLed& led : snapshot.leds)
      cameras = std::min(cameras, led.cameras.size());
  }
  EXPECT_GT(check.snapshots, 300u);
  EXPECT_EQ(0u, check.uncovered);
  EXPECT_EQ(0u, check.false_tracks);
  EXPECT_LT(check.rms(), 0.002);
  EXPECT_GE(cameras, 35u);
}

TEST(Tracker, ANewRigTakesOverTheTracks) {
  const std::vector<Path> leds = wanderers(3, 12);
  const geometry::Rig rig = paperRig();
  std::vector<SceneImage> images = imagesOf(rig, leds, {}, 1200);
  Tracker tracker(rig, exactOptions());
  track(&tracker, {images.begin(), images.begin() + 600});
  tracker.setRig(rig);  // the same: nothing happens
  Tracker undisturbed(rig, exactOptions());
  track(&undisturbed, {images.begin(), images.begin() + 600});
  expectSameLeds(stateAt(undisturbed, 1001.6), stateAt(tracker, 1001.6));

  geometry::Rig fewer = rig;
  fewer.cameras = {rig.cameras[3], rig.cameras[0], rig.cameras[1]};
  tracker.setRig(fewer);
  const std::array<std::size_t, 4> place = {1, 2, 9, 0};
  IdentityCheck check(leds);
  for (std::size_t i = 600; i < images.size(); ++i) {
    if (images[i].camera == 2)
      continue;
    tracker.add(place[images[i].camera], images[i].image);
    while (const Snapshot* snapshot = tracker.next()) {
      check.add(*snapshot);
      std::set<std::uint32_t> ids = idsIn(*snapshot, TrackState::kTracked);
      if (i < 604)  // not all cameras of the new rig had an image yet
        ids.merge(idsIn(*snapshot, TrackState::kPredicted));
      EXPECT_EQ((std::set<std::uint32_t>{0, 1, 2}), ids);
      EXPECT_EQ(3u, snapshot->views.size());
    }
  }
  EXPECT_EQ(0u, check.uncovered);
  EXPECT_GT(check.snapshots, 400u);

  geometry::Rig broken = rig;
  broken.cameras[0].camera.intrinsics.fx = kNan;
  EXPECT_THROW(tracker.setRig(broken), geometry::Error);
}

TEST(Tracker, MaskedSpotsAreReportedAndNotUsed) {
  const Eigen::Vector3d place(1.25, 1.25, 1.0);
  geometry::Rig rig = paperRig();
  rig.cameras[0].masks.push_back({*rig.cameras[0].camera.project(place), 30.0});
  Tracker tracker(rig, exactOptions());
  const Snapshot last = track(&tracker, imagesOf(rig, {still(place)}, SceneOptions(), 400)).back();
  ASSERT_EQ(1u, last.leds.size());
  EXPECT_EQ((CameraList{1, 2, 3}), last.leds[0].cameras);
  EXPECT_EQ(3u, last.leds[0].rays_possible);
  ASSERT_EQ(1u, last.views[0].spots.size());
  EXPECT_EQ(SpotUse::kMasked, last.views[0].spots[0].use);
  EXPECT_EQ(SpotUse::kAssigned, last.views[1].spots[0].use);
  EXPECT_EQ(last.leds[0].id, last.views[1].spots[0].led);
}

TEST(Tracker, RoomsAreIndependent) {
  const geometry::Rig rig = roomsRig(2, 3);
  geometry::test::Random random(15);
  const std::vector<Path> leds = {wandering(random, {0.3, 0.0, 1.0}, 0.3, 1.0),
                                  wandering(random, {100.0, 0.3, 1.0}, 0.3, 1.0)};
  const std::vector<SceneImage> images = imagesOf(rig, leds, {}, 1200);
  std::vector<SceneImage> first_room;
  std::copy_if(images.begin(), images.end(), std::back_inserter(first_room),
               [](const SceneImage& image) { return image.camera < 3; });
  Tracker both(rig, exactOptions());
  track(&both, images);
  Tracker first(rig, exactOptions());
  track(&first, first_room);
  const Snapshot a = stateAt(both, 1003.0);
  const Snapshot b = stateAt(first, 1003.0);
  ASSERT_EQ(2u, a.leds.size());
  ASSERT_EQ(1u, b.leds.size());
  const bool first_is_0 = a.leds[0].position.x() < 50.0;
  EXPECT_EQ(a.leds[first_is_0 ? 0 : 1].position, b.leds[0].position);
}

TEST(Tracker, TheCovarianceContainsTheCalibrations) {
  const Eigen::Vector3d place(1.25, 1.25, 1.0);
  const auto images = imagesOf(paperRig(), {still(place)}, SceneOptions(), 800);
  Tracker exactly(paperRig(), exactOptions());
  const TrackedLed known = track(&exactly, images).back().leds.at(0);
  geometry::Rig rig = paperRig();
  rig.covariance = 1e-6 * Eigen::MatrixXd::Identity(64, 64);
  geometry::CalibrationUncertainty uncertainty(rig);
  const auto share =
      uncertainty.covarianceNear(known.position, known.cameras.data(), known.cameras.size());
  ASSERT_TRUE(share);
  EXPECT_GT(share->trace(), 0.0);
  Tracker uncertain(rig, exactOptions());
  const TrackedLed led = track(&uncertain, images).back().leds.at(0);
  EXPECT_EQ(known.position, led.position);
  EXPECT_LT((led.position_covariance - known.position_covariance - *share).norm(),
            1e-9 * share->norm());
  EXPECT_EQ(known.velocity_covariance, led.velocity_covariance);
}

TEST(Tracker, APredictionIsNotMoreCertainThanWhatItBeginsWith) {
  geometry::Rig rig = paperRig();
  rig.covariance = 1e-6 * Eigen::MatrixXd::Identity(64, 64);
  SceneOptions scene;
  scene.hidden = [](std::size_t camera, std::size_t, double t) {
    return t > (camera == 2 ? 1001.2 : 1001.0);  // one camera alone sees it at last
  };
  Tracker tracker(rig, exactOptions());
  double tracked = 0.0;
  std::size_t predictions = 0;
  for (const Snapshot& s : track(&tracker, imagesOf(rig, {still({1.25, 1.25, 1.0})}, scene, 500))) {
    if (s.time < 1000.5 || s.leds.empty())
      continue;
    const TrackedLed& led = s.leds[0];
    const double variance = led.position_covariance.trace();
    if (led.state == TrackState::kTracked)
      tracked = variance;
    if (led.state != TrackState::kPredicted)
      continue;
    ++predictions;
    EXPECT_GE(variance, 0.99 * tracked) << s.time;
  }
  EXPECT_GT(predictions, 50u);
}

/// Mean NEES per dimension of an LED that wanders, in cameras of this noise, which they learnt
/// [px].
double neesWith(double noise, bool learnt_noise) {
  geometry::Rig rig = paperRig();
  for (geometry::RigCamera& camera : rig.cameras) {
    camera.residual_px = std::sqrt(2.0) * noise;
    camera.inliers = 1000;
  }
  SceneOptions scene;
  scene.pixel_noise = noise;
  TrackerOptions options;
  options.stamp_stddev = 0.0;
  options.learnt_noise = learnt_noise;
  const std::vector<Path> leds = wanderers(1, 4);
  Tracker tracker(rig, options);
  geometry::test::Accuracy accuracy;
  for (const Snapshot& snapshot : track(&tracker, imagesOf(rig, leds, scene, 8000))) {
    if (snapshot.leds.size() != 1 || snapshot.leds[0].state != TrackState::kTracked)
      continue;
    const TrackedLed& led = snapshot.leds[0];
    accuracy.add(led.position - leds[0](snapshot.time), led.position_covariance);
  }
  EXPECT_GT(accuracy.count, 7000);
  return accuracy.nees() / 3.0;
}

TEST(Tracker, CovarianceFollowsTheNoiseThatCamerasLearnt) {
  EXPECT_NEAR(neesWith(0.15, true), 1.0, 0.2);
  EXPECT_LT(neesWith(0.15, false), 0.5);
  EXPECT_NEAR(neesWith(0.5, true), neesWith(0.5, false), 1e-6);
}

TEST(Tracker, MakeEstimatorMakesBothKinds) {
  estimators::EstimatorOptions options;
  EXPECT_TRUE(dynamic_cast<Tracker*>(estimators::makeEstimator(paperRig(), options).get()));
  options.tracker_mode = estimators::TrackerMode::kInstant;
  EXPECT_TRUE(
      dynamic_cast<fusion::InstantFuser*>(estimators::makeEstimator(paperRig(), options).get()));
  EXPECT_THROW(estimators::makeEstimator(geometry::Rig(), options), geometry::Error);
}

}  // namespace
}  // namespace wiimote_tracker::tracking::test
