// Sightings of blinking LEDs in images, and tracks that survive dark intervals.
#include "identity/blinking.h"
#include "tracking/scene.h"
#include "wiimote_tracker_triangulation/identity/blink_codes.h"
#include "wiimote_tracker_triangulation/identity/snapshot_sightings.h"
#include "wiimote_tracker_triangulation/tracking/tracker.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <set>
#include <string>

namespace wiimote_tracker::identity {
namespace {

using test::fourWords;
using test::paperCodes;

/// Two cameras that look at the origin, and one that looks away.
geometry::Rig threeCameras() {
  geometry::Rig rig;
  for (const Eigen::Vector3d& position :
       {Eigen::Vector3d(3, 0, 0), Eigen::Vector3d(0, 3, 0), Eigen::Vector3d(-3, 0, 0)}) {
    geometry::RigCamera camera;
    camera.camera.name = "camera_" + std::to_string(rig.cameras.size());
    const Eigen::Vector3d target =
        position.x() < 0 ? Eigen::Vector3d(-6, 0, 0) : Eigen::Vector3d(0, 0, 0);
    camera.camera.world_from_camera = geometry::lookAt(position, target, {0, 0, 1});
    rig.cameras.push_back(camera);
  }
  return rig;
}

class Sightings : public testing::Test {
 protected:
  Sightings() {
    snapshot_.time = 10.0;
    snapshot_.views.resize(3);
    for (tracking::CameraView& view : snapshot_.views)
      view.time = 9.995;
    tracking::TrackedLed led;
    led.id = 7;
    led.state = tracking::TrackState::kPredicted;
    snapshot_.leds.push_back(led);
  }

  void see(std::size_t camera, const Eigen::Vector2d& offset, std::optional<std::uint32_t> led) {
    tracking::SeenSpot spot;
    spot.pixel = *rig_.cameras[camera].camera.project(Eigen::Vector3d::Zero()) + offset;
    spot.use = led ? tracking::SpotUse::kAssigned : tracking::SpotUse::kUnassigned;
    spot.led = led.value_or(0);
    snapshot_.views[camera].spots.push_back(spot);
  }

  /// Per camera: s(een), u(nseen), or nothing.
  std::string collect() {
    std::string text;
    for (const TrackSighting& s : sightings_.collect(rig_, snapshot_)) {
      EXPECT_EQ(7u, s.led);
      EXPECT_EQ(9.995, s.sighting.time);
      EXPECT_EQ(0.002, s.sighting.exposure);
      text += (s.sighting.seen ? "s" : "u") + std::to_string(s.sighting.camera);
    }
    return text;
  }

  geometry::Rig rig_ = threeCameras();
  tracking::Snapshot snapshot_;
  SnapshotSightings sightings_{{0.002, 24.0}};
};

TEST_F(Sightings, SeenAndNotSeenByCamerasThatLookThere) {
  see(0, {0, 0}, 7);
  see(1, {100, 0}, 8);
  EXPECT_EQ("s0u1", collect());
  EXPECT_EQ("", collect()) << "the same images again";
}

TEST_F(Sightings, AnImageThatNeedNotShowItIsNoEvidence) {
  see(0, {9, 0}, 8);               // perhaps both in one spot
  snapshot_.views[1].full = true;  // perhaps crowded out
  EXPECT_EQ("", collect());
}

TEST_F(Sightings, ASpotThatMayBeAnotherLedsIsNoEvidence) {
  see(0, {9, 0}, 7);
  tracking::TrackedLed other = snapshot_.leds[0];
  other.id = 8;
  snapshot_.leds.push_back(other);
  snapshot_.views[1].time.reset();
  EXPECT_EQ("", collect()) << "either LED's light";
  snapshot_.views[0].time = 9.996;
  snapshot_.leds[1].state = tracking::TrackState::kTentative;
  EXPECT_EQ(1u, sightings_.collect(rig_, snapshot_).size()) << "a tentative LED does not count";
}

TEST_F(Sightings, AreLookedForWhereTheRaysOfTheRigAre) {
  rig_.ray_model = geometry::RayModel::kImageCenter;
  rig_.cameras[0].camera.intrinsics.cx += 100.0;
  tracking::SeenSpot spot;
  spot.pixel = *rig_.rayCamera(rig_.cameras[0]).project(Eigen::Vector3d::Zero());
  spot.use = tracking::SpotUse::kAssigned;
  spot.led = 8;
  snapshot_.views[0].spots.push_back(spot);
  EXPECT_EQ("u1", collect()) << "perhaps both in one spot";
}

TEST_F(Sightings, MaskedRegionsSeeNothing) {
  rig_.cameras[1].masks.push_back({*rig_.cameras[1].camera.project(Eigen::Vector3d::Zero()), 20.0});
  EXPECT_EQ("u0", collect());
}

TEST_F(Sightings, LostLedsAreForgotten) {
  see(0, {0, 0}, 7);
  Identifier identifier(fourWords(), {});
  sightings_.add(rig_, snapshot_, &identifier);
  EXPECT_NE(nullptr, identifier.identityOf(7));
  snapshot_.leds[0].state = tracking::TrackState::kLost;
  snapshot_.time += 0.01;
  snapshot_.views[0].time = 10.005;
  sightings_.add(rig_, snapshot_, &identifier);
  EXPECT_EQ(nullptr, identifier.identityOf(7));
}

/// An LED with a label of the codes, seen by the first `cameras` of the paper's rig: how often it
/// was tracked, its ids, and its final label.
struct Followed {
  std::set<std::uint32_t> ids;
  std::size_t tracked = 0, predicted = 0, lost = 0;
  std::optional<std::size_t> label;
};

Followed follow(const BlinkCodes& codes, double period, std::size_t label, std::size_t cameras) {
  tracking::test::SceneOptions scene_options;
  scene_options.dropout = 0.02;
  scene_options.hidden = [&](std::size_t, std::size_t, double time) {
    return litShare(codes.codes[label].waveform, (time - 0.0005) / period, 0.001 / period) < 0.5;
  };
  geometry::Rig rig = tracking::test::paperRig();
  rig.cameras.resize(cameras);
  tracking::test::Scene scene(rig, {tracking::test::still({1.2, 1.3, 1.0})}, scene_options, 5);
  tracking::Tracker tracker(rig, forBlinking(codes, tracking::TrackerOptions()));
  Identifier identifier(codes, {});
  SnapshotSightings sightings({});
  Followed followed;
  while (true) {
    const tracking::test::SceneImage& image = scene.next();
    if (image.true_time > scene_options.start + 4.0)
      return followed;
    tracker.add(image.camera, image.image);
    while (const tracking::Snapshot* snapshot = tracker.next()) {
      sightings.add(rig, *snapshot, &identifier);
      for (const tracking::TrackedLed& led : snapshot->leds) {
        followed.tracked += led.state == tracking::TrackState::kTracked;
        followed.predicted += led.state == tracking::TrackState::kPredicted;
        followed.lost += led.state == tracking::TrackState::kLost && followed.ids.count(led.id);
        if (led.state == tracking::TrackState::kTracked)
          followed.ids.insert(led.id);
        if (identifier.identityOf(led.id))
          followed.label = identifier.identityOf(led.id)->label;
      }
    }
  }
}

TEST(BlinkingTracks, SurviveDarkness) {
  const BlinkCodes paper = paperCodes(0.11, 0.25);
  const BlinkCodes words = fourWords();
  for (const std::size_t cameras : {2, 4}) {
    for (std::size_t label = 0; label < 4; ++label) {
      const Followed blinks = follow(words, 0.184, label, cameras);
      EXPECT_EQ(1u, blinks.ids.size()) << "word " << label << ", cameras " << cameras;
      EXPECT_EQ(0u, blinks.lost);
      EXPECT_EQ(0u, blinks.predicted) << "it is dark for less than tracked_time";
      EXPECT_EQ(label, blinks.label);
      const Followed together = follow(paper, 0.15, label, cameras);
      EXPECT_EQ(0u, together.lost);
      EXPECT_EQ(1u, together.ids.size()) << "share " << label << ", cameras " << cameras;
      EXPECT_EQ(label, together.label) << "cameras " << cameras;
      if (label == 3) {
        EXPECT_GT(together.predicted, 0u) << "it is dark for 0.12 s";
      }
    }
  }
}

TEST(BlinkingTracks, AreSeenAsOftenAsTheyAreLit) {
  tracking::TrackerOptions options;
  options.detection_probability = 0.8;
  options.prediction_time = 0.1;
  // On for 0.2 to 0.9 of the period: 0.525 on average, and dark for up to 0.8 of 0.25 s.
  const tracking::TrackerOptions blinking = forBlinking(paperCodes(0.11, 0.25), options);
  EXPECT_NEAR(blinking.detection_probability, 0.525 * 0.8, 1e-12);
  EXPECT_NEAR(blinking.dark_time, 0.2, 1e-12);
  EXPECT_NEAR(blinking.prediction_time, 0.4, 1e-12);
}

}  // namespace
}  // namespace wiimote_tracker::identity
