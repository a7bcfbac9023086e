#pragma once

#include "geometry/random_rigs.h"
#include "wiimote_tracker_triangulation/fusion/instant_fuser.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace wiimote_tracker::fusion::test {

constexpr double kPeriod = 0.01;   // [s]
constexpr double kLatency = 0.02;  // [s]

/// An image of one camera on its way to the fuser.
struct Delivery {
  std::size_t camera;
  tracking::CameraImage image;
};

inline tracking::Spot spotAt(const Eigen::Vector2d& pixel) {
  tracking::Spot spot;
  spot.pixel = pixel;
  return spot;
}

inline tracking::CameraImage imageOf(const geometry::RigCamera& camera,
                                     const Eigen::Vector3d& led,
                                     double stamp) {
  tracking::CameraImage image;
  image.stamp = stamp;
  image.arrival = stamp + kLatency;
  if (const auto pixel = camera.camera.project(led))
    image.spots.push_back(spotAt(*pixel));
  return image;
}

/// Images of all cameras from `begin` to `end`, each camera at its own phase, in order of arrival.
inline std::vector<Delivery> film(const geometry::Rig& rig,
                                  double begin,
                                  double end,
                                  const std::function<Eigen::Vector3d(double)>& path) {
  std::vector<Delivery> deliveries;
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    const double phase = kPeriod * (0.1 + 0.3 * c);
    for (int i = 0; begin + phase + i * kPeriod < end; ++i) {
      const double stamp = begin + phase + i * kPeriod;
      deliveries.push_back({c, imageOf(rig.cameras[c], path(stamp), stamp)});
    }
  }
  std::stable_sort(deliveries.begin(), deliveries.end(),
                   [](const auto& a, const auto& b) { return a.image.arrival < b.image.arrival; });
  return deliveries;
}

/// The first LED that is there; null when none is.
inline const tracking::TrackedLed* ledOf(const tracking::Snapshot& snapshot) {
  const auto led = std::find_if(snapshot.leds.begin(), snapshot.leds.end(), [](const auto& l) {
    return l.state != tracking::TrackState::kLost;
  });
  return led == snapshot.leds.end() ? nullptr : &*led;
}

inline bool uses(const tracking::TrackedLed& led, std::size_t camera) {
  return std::count(led.cameras.begin(), led.cameras.end(), camera) > 0;
}

inline std::vector<tracking::Snapshot> fuse(InstantFuser& fuser,
                                            const std::vector<Delivery>& deliveries) {
  std::vector<tracking::Snapshot> instants;
  for (const Delivery& delivery : deliveries) {
    fuser.add(delivery.camera, delivery.image);
    while (const tracking::Snapshot* instant = fuser.next())
      instants.push_back(*instant);
  }
  return instants;
}

inline Eigen::Vector3d still(double) {
  return {0.1, 0.2, 0.3};
}

inline geometry::Rig threeCameras() {
  geometry::test::Random random(51);
  return geometry::test::randomRig(random, 3);
}

inline void expectIncreasing(const std::vector<tracking::Snapshot>& instants) {
  for (std::size_t i = 1; i < instants.size(); ++i)
    ASSERT_GT(instants[i].time, instants[i - 1].time);
}

inline std::uint64_t lateImages(const InstantFuser& fuser) {
  return fuser.counters().late + fuser.counters().repeated;
}

/// A path: 1 m/s on a circle of 0.5 m.
inline Eigen::Vector3d circle(double t) {
  return {0.5 * std::cos(2.0 * t), 0.5 * std::sin(2.0 * t), 0.2};
}

}  // namespace wiimote_tracker::fusion::test
