// Which cameras do not fit the others: those that were turned or exchanged, not those that people
// stand in front of.
#include "tracking/tracker_runs.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace wiimote_tracker::tracking::test {
namespace {

TEST(TrackerFit, CamerasThatFitNothingAreNamedAndLeftOut) {
  const geometry::Rig rig = roomsRig(1, 5);
  geometry::test::Random random(10);
  std::vector<Path> leds;
  for (const double x : {-0.4, 0.4})
    leds.push_back(wandering(random, {x, 0.1, 1.0}, 0.25, 1.0));
  geometry::Rig turned = rig;  // upside down, after the calibration
  turned.cameras[2].camera.world_from_camera.rotate(
      Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()));
  geometry::Rig exchanged = rig;
  std::swap(exchanged.cameras[1].camera, exchanged.cameras[2].camera);
  for (const auto& [truth, wrong] : std::vector<std::pair<geometry::Rig, std::set<std::size_t>>>{
           {rig, {}}, {turned, {2}}, {exchanged, {1, 2}}}) {
    SceneOptions options;
    options.dropout = 0.1;
    options.ghosts = 0.5;
    Scene scene(truth, leds, options, 3);
    Tracker tracker(rig, exactOptions());
    IdentityCheck check(leds);
    for (int i = 0; i < 4000; ++i) {  // 8 s
      const SceneImage& image = scene.next();
      tracker.add(image.camera, image.image);
      while (const Snapshot* snapshot = tracker.next()) {
        if (snapshot->time > options.start + 5.0)
          check.add(*snapshot);
      }
    }
    for (std::size_t camera = 0; camera < 5; ++camera) {
      const auto fault = tracker.cameraFault(camera);
      EXPECT_EQ(wrong.count(camera) == 1, fault && fault->kind == CameraFault::Kind::kMisfit)
          << "camera " << camera << " of " << wrong.size() << " that are wrong";
    }
    EXPECT_EQ(0u, check.uncovered) << wrong.size();
    EXPECT_EQ(0u, check.false_tracks) << wrong.size();
    EXPECT_LT(check.rms(), 0.003) << wrong.size();
  }
}

TEST(TrackerFit, ACameraThatABodyBlocksIsRight) {
  for (const bool lamp : {false, true}) {
    SceneOptions options;
    options.ghosts = 0.5;
    options.reflections.resize(4);
    if (lamp)
      options.reflections[1] = {{100.0, 100.0}};
    options.hidden = [](std::size_t camera, std::size_t, double time) {
      return camera == 1 && std::fmod(time, 10.0) > 2.0;
    };
    Scene scene(paperRig(), wanderers(2, 1), options, 1);
    Tracker tracker(paperRig(), exactOptions());
    IdentityCheck check(scene.leds());
    for (int i = 0; i < 4000; ++i) {  // 10 s
      const SceneImage& image = scene.next();
      tracker.add(image.camera, image.image);
      ASSERT_FALSE(tracker.cameraFault(image.camera)) << lamp << ", image " << i;
      while (const Snapshot* snapshot = tracker.next())
        check.add(*snapshot);
    }
    EXPECT_GT(check.near, 7000u) << lamp;
  }
}

TEST(TrackerFit, CamerasThatSeeDifferentLedsAreRight) {
  SceneOptions options;
  options.ghosts = 0.5;
  options.hidden = [](std::size_t camera, std::size_t led, double time) {
    const auto first = static_cast<std::size_t>(time / 0.5) + led;  // two cameras see each LED
    return camera != first % 4 && camera != (first + 1) % 4;
  };
  Scene scene(paperRig(), wanderers(2, 1), options, 1);
  Tracker tracker(paperRig(), exactOptions());
  IdentityCheck check(scene.leds());
  for (int i = 0; i < 4000; ++i) {  // 10 s
    const SceneImage& image = scene.next();
    tracker.add(image.camera, image.image);
    ASSERT_FALSE(tracker.cameraFault(image.camera)) << "image " << i;
    while (const Snapshot* snapshot = tracker.next())
      check.add(*snapshot);
  }
  EXPECT_GT(check.near, 7000u);
}

}  // namespace
}  // namespace wiimote_tracker::tracking::test
