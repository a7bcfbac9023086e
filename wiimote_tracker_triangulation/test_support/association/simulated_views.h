#pragma once

#include "association/associate_views.h"
#include "geometry/random_rigs.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace wiimote_tracker::association::test {

using geometry::test::Random;

/// The paper's arrangement: cameras on a circle of 4 m around a cube of 2.5 m, 2.5 m high, all
/// looking at its centre; four are on its diagonals, two or three on some of them.
inline geometry::Rig ringRig(int cameras) {
  geometry::Rig rig;
  for (int i = 0; i < cameras; ++i) {
    const double angle = 2.0 * M_PI * (i + 0.5) / std::max(cameras, 4);
    geometry::RigCamera camera;
    camera.camera.name = "camera_" + std::to_string(i);
    camera.camera.world_from_camera =
        geometry::lookAt({4.0 * std::cos(angle), 4.0 * std::sin(angle), 2.5}, {0.0, 0.0, 1.25},
                         Eigen::Vector3d::UnitZ());
    rig.cameras.push_back(camera);
  }
  return rig;
}

struct Disturbance {
  double pixel_stddev = 0.5;  ///< [px]
  double dropout = 0.0;       ///< Probability that a camera misses an LED.
  int ghosts = 0;             ///< Per image, anywhere.
  std::size_t most_spots = 4;
};

/// What the cameras see of some LEDs at one time.
struct SimulatedViews {
  std::vector<std::vector<Eigen::Vector2d>> pixels;
  std::vector<std::vector<int>> leds;  ///< Of each spot; -1: a ghost.
  std::vector<std::vector<geometry::Sight>> sights;
  std::vector<View> views;
};

/// LEDs anywhere in the cube of 2.5 m where all cameras see them.
inline std::vector<Eigen::Vector3d> randomLeds(Random& random,
                                               const geometry::Rig& rig,
                                               int count) {
  std::vector<Eigen::Vector3d> leds;
  while (static_cast<int>(leds.size()) < count) {
    const Eigen::Vector3d led = random.inBox(1.25) + Eigen::Vector3d(0.0, 0.0, 1.25);
    if (std::all_of(rig.cameras.begin(), rig.cameras.end(),
                    [&](const geometry::RigCamera& camera) { return camera.camera.sees(led); }))
      leds.push_back(led);
  }
  return leds;
}

/// The spots of each image in random order; of too many, some are left out at random.
inline SimulatedViews simulateViews(Random& random,
                                    const geometry::Rig& rig,
                                    const std::vector<Eigen::Vector3d>& leds,
                                    const Disturbance& disturbance) {
  SimulatedViews result;
  for (const geometry::RigCamera& camera : rig.cameras) {
    std::vector<std::pair<Eigen::Vector2d, int>> spots;
    for (std::size_t led = 0; led < leds.size(); ++led) {
      const auto pixel = camera.camera.project(leds[led]);
      if (!pixel || random.uniform(0.0, 1.0) < disturbance.dropout)
        continue;
      const double u = pixel->x() + disturbance.pixel_stddev * random.gaussian();
      const double v = pixel->y() + disturbance.pixel_stddev * random.gaussian();
      spots.push_back({Eigen::Vector2d(u, v), static_cast<int>(led)});
    }
    for (int i = 0; i < disturbance.ghosts; ++i) {
      const double u = random.uniform(0.0, camera.camera.intrinsics.width - 1.0);
      const double v = random.uniform(0.0, camera.camera.intrinsics.height - 1.0);
      spots.push_back({Eigen::Vector2d(u, v), -1});
    }
    for (std::size_t i = spots.size(); i > 1; --i)
      std::swap(spots[i - 1],
                spots[static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(i)))]);
    if (spots.size() > disturbance.most_spots)
      spots.resize(disturbance.most_spots);
    result.pixels.emplace_back();
    result.leds.emplace_back();
    result.sights.emplace_back();
    for (const auto& [pixel, led] : spots) {
      result.pixels.back().push_back(pixel);
      result.leds.back().push_back(led);
      result.sights.back().push_back(*geometry::sightFromPixel(camera.camera, pixel));
    }
  }
  for (const auto& sights : result.sights)
    result.views.push_back({sights.data(), sights.size(), true, false});
  return result;
}

}  // namespace wiimote_tracker::association::test
