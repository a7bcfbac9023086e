// The stated errors of a body's pose where the times of images are uncertain.
#include "body/body_scene.h"
#include "body/body_tracker.h"
#include "wiimote_tracker_triangulation/tracking/tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <functional>
#include <string>

namespace wiimote_tracker::body {
namespace {

using Eigen::Isometry3d;

/// On a circle at 1 m/s.
Isometry3d circling(double t) {
  constexpr double kRadius = 0.4;  // [m]
  return Isometry3d(Eigen::Translation3d(1.25 + kRadius * std::cos(t / kRadius),
                                         1.25 + kRadius * std::sin(t / kRadius), 1.1));
}

/// Mean squared normalised error per coordinate of the pose of a circling body, from a time on [s].
/// @param take gives an image to the tracker.
double meanNees(const geometry::Rig& rig,
                const tracking::test::SceneOptions& options,
                unsigned seed,
                double begin,
                const std::function<void(tracking::test::SceneImage*, BodyTracker*)>& take) {
  BodyTracker body_tracker((BodyTrackerOptions()));
  body_tracker.setBodies({test::fourLeds()});
  body_tracker.setRig(rig);
  tracking::test::Scene scene(rig, test::pathsOf(test::fourLeds(), circling), options, seed);
  double nees = 0.0;
  double count = 0.0;
  for (double time = 0.0; time < 1005.0;) {
    tracking::test::SceneImage image = scene.next();
    time = image.true_time;
    take(&image, &body_tracker);
    const BodySnapshot* snapshot = body_tracker.next();
    if (!snapshot || time < begin)
      continue;
    const BodyEstimate& body = snapshot->bodies[0].value();
    count += 6.0;
    nees += test::normalisedError(circling(snapshot->time), body.world_from_body,
                                  body.covariance.topLeftCorner<6, 6>());
  }
  return nees / count;
}

/// Stamps have errors of 2 ms.
TEST(BodyTracker, StatesTheErrorsOfStamps) {
  tracking::test::SceneOptions options;
  options.pixel_noise = 0.5;
  options.stamp_noise = 0.002;
  const auto take = [](tracking::test::SceneImage* image, BodyTracker* body_tracker) {
    body_tracker->take(image->camera, {}, &image->image);
  };
  for (const std::size_t cameras : {4, 2}) {
    geometry::Rig rig = tracking::test::paperRig();
    rig.cameras.resize(cameras);
    double nees = 0.0;
    for (unsigned seed = 1; seed < 5; ++seed)
      nees += meanNees(rig, options, seed, 1001.0, take) / 4.0;
    RecordProperty(std::to_string(cameras) + "_cameras", std::to_string(nees));
    EXPECT_GT(nees, 0.8);
    EXPECT_LT(nees, 1.25);
  }
}

/// After a reconnection the stamps of a camera are 5 ms late, which nothing but bodies shows.
TEST(BodyTracker, StatesWhatIsNotKnownOfAClock) {
  tracking::test::SceneOptions options;
  options.pixel_noise = 0.5;
  geometry::Rig rig = tracking::test::paperRig();
  rig.cameras[0].time_offset = 0.0;
  rig.cameras[0].time_offset_rule = geometry::TimeOffsetRule::kOneEpoch;
  double nees = 0.0;
  for (unsigned seed = 1; seed < 5; ++seed) {
    tracking::Tracker tracker(rig, tracking::test::exactOptions());
    const auto take = [&](tracking::test::SceneImage* shown, BodyTracker* body_tracker) {
      tracking::CameraImage& image = shown->image;
      if (shown->camera == 0) {
        image.clock_epoch = rig.cameras[0].time_offset_epoch + 1;
        image.stamp += 0.005;
      }
      body_tracker->take(shown->camera, tracker.clockError(shown->camera, image.clock_epoch),
                         &image);
      tracker.add(shown->camera, image);
    };
    nees += meanNees(rig, options, seed, 1000.5, take) / 4.0;
  }
  RecordProperty("nees", std::to_string(nees));
  EXPECT_GT(nees, 0.8);
  EXPECT_LT(nees, 1.5);
}

}  // namespace
}  // namespace wiimote_tracker::body
