// LEDs on one hand: their spots merge, and some are hidden meanwhile.
#include "geometry/accuracy.h"
#include "tracking/tracker_runs.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <map>
#include <vector>

namespace wiimote_tracker::tracking::test {
namespace {

constexpr double kHiddenFrom = 1005.0;  // the last LED, for all cameras [s]
constexpr double kHiddenTo = 1005.4;

/// Three LEDs 7 to 11 cm apart on a hand that turns.
std::vector<Path> hand() {
  const Path wrist = wanderers(1, 8, 0.7)[0];
  std::vector<Path> leds;
  for (const Eigen::Vector3d& offset :
       {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(0.07, 0.0, 0.02),
        Eigen::Vector3d(0.03, 0.04, 0.1)}) {
    leds.push_back([wrist, offset](double t) {
      const Eigen::Matrix3d turn =
          (Eigen::AngleAxisd(1.9 * std::sin(0.9 * t), Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(1.3 * std::sin(0.7 * t), Eigen::Vector3d::UnitX()))
              .toRotationMatrix();
      return Eigen::Vector3d(wrist(t) + turn * offset);
    });
  }
  return leds;
}

/// Each LED is hidden from each camera for 0.3 s of 2.3 s, from at most two at once.
bool isHidden(std::size_t camera, std::size_t led, double t) {
  return (led == 2 && t >= kHiddenFrom && t < kHiddenTo) ||
         std::fmod(t + 0.45 * static_cast<double>(camera) + 0.7 * static_cast<double>(led), 2.3) <
             0.3;
}

TEST(TrackerCloseLeds, HiddenLedsAreNotTakenForMergedOnes) {
  const std::vector<Path> leds = hand();
  struct Case {
    double merging_distance;  // [px]
    double rms;               // [m]
    double inside;            // share inside the 95 % ellipsoid
  };
  for (const Case& expected : {Case{6.0, 0.004, 0.94}, Case{8.0, 0.005, 0.9}}) {
    SceneOptions scene;
    scene.merging_distance = expected.merging_distance;
    scene.hidden = isHidden;
    Tracker tracker(paperRig(), exactOptions());
    std::map<std::uint32_t, std::size_t> led_of_id;
    geometry::test::Accuracy tracked;
    for (const Snapshot& s : track(&tracker, imagesOf(paperRig(), leds, scene, 4800))) {
      for (const TrackedLed& track : s.leds) {
        if (s.time < 1001.0 || track.state != TrackState::kTracked)
          continue;
        std::size_t nearest = 0;
        for (std::size_t led = 1; led < leds.size(); ++led) {
          if ((leds[led](s.time) - track.position).norm() <
              (leds[nearest](s.time) - track.position).norm())
            nearest = led;
        }
        const std::size_t own = led_of_id.emplace(track.id, nearest).first->second;
        tracked.add(track.position - leds[own](s.time), track.position_covariance);
        EXPECT_FALSE(own == 2 && s.time > kHiddenFrom + 0.1 && s.time < kHiddenTo) << s.time;
      }
    }
    EXPECT_LE(led_of_id.size(), 3u);
    EXPECT_GE(tracked.count, 3 * 4400 * 95 / 100);
    EXPECT_LT(tracked.rms(), expected.rms) << expected.merging_distance;
    EXPECT_GT(tracked.shareInside(), expected.inside) << expected.merging_distance;
    for (std::size_t camera = 0; camera < 4; ++camera)
      EXPECT_FALSE(tracker.cameraFault(camera)) << camera;
  }
}

}  // namespace
}  // namespace wiimote_tracker::tracking::test
