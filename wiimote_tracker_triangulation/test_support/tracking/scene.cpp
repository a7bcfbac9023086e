#include "tracking/scene.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace wiimote_tracker::tracking::test {
namespace {

geometry::RigCamera lookingAt(const std::string& name,
                              const Eigen::Vector3d& position,
                              const Eigen::Vector3d& target) {
  geometry::RigCamera camera;
  camera.camera.name = name;
  camera.camera.world_from_camera = geometry::lookAt(position, target, Eigen::Vector3d::UnitZ());
  return camera;
}

bool arrivesLater(const SceneImage& a, const SceneImage& b) {
  return std::make_pair(a.image.arrival, a.camera) > std::make_pair(b.image.arrival, b.camera);
}

/// Whether several LEDs made a spot: more than one bit is set.
bool isMerged(std::uint64_t leds) {
  return (leds & (leds - 1)) != 0;
}

}  // namespace

geometry::Rig paperRig() {
  struct Lens {
    double fx, fy, cx, cy, k1;
  };
  const Lens lenses[] = {{1374.8594, 1370.6494, 530.7089, 394.4315, -0.0531},
                         {1305.9753, 1301.9763, 530.2055, 393.6506, 0.0063},
                         {1322.8006, 1318.7500, 519.0160, 388.4064, -0.0095},
                         {1333.3280, 1329.2452, 543.4179, 382.1168, -0.0224}};
  geometry::Rig rig;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d position(i == 1 || i == 2 ? 5.68198 : -3.18198,
                                   i == 2 || i == 3 ? 5.68198 : -3.18198, 2.0);
    geometry::RigCamera camera =
        lookingAt("wiimote_" + std::to_string(i + 1), position, {1.25, 1.25, 1.0});
    geometry::Intrinsics& lens = camera.camera.intrinsics;
    lens.fx = lenses[i].fx;
    lens.fy = lenses[i].fy;
    lens.cx = lenses[i].cx;
    lens.cy = lenses[i].cy;
    lens.distortion[0] = lenses[i].k1;
    rig.cameras.push_back(camera);
  }
  return rig;
}

geometry::Rig roomsRig(int rooms, int cameras_per_room) {
  geometry::Rig rig;
  for (int room = 0; room < rooms; ++room) {
    const Eigen::Vector3d middle(100.0 * room, 0.0, 1.0);
    for (int i = 0; i < cameras_per_room; ++i) {
      // Slightly uneven, so that no two face each other.
      const double angle = 2.0 * M_PI * (i + 0.2 * (i % 2)) / cameras_per_room + 0.3;
      const Eigen::Vector3d position =
          middle + Eigen::Vector3d(5.0 * std::cos(angle), 5.0 * std::sin(angle), 1.5);
      rig.cameras.push_back(lookingAt(
          "room_" + std::to_string(room) + "_camera_" + std::to_string(i), position, middle));
    }
  }
  return rig;
}

Scene::Scene(const geometry::Rig& rig,
             const std::vector<Path>& leds,
             const SceneOptions& options,
             unsigned seed)
    : rig_(rig), leds_(leds), options_(options), random_(seed), slots_(rig.cameras.size()) {
  for (std::size_t i = 0; i < rig_.cameras.size(); ++i) {
    const double phase = options_.synchronised ? 0.0 : random_.uniform(0.0, options_.period);
    const double skew = options_.clock_skew * random_.uniform(-1.0, 1.0);
    clocks_.push_back({options_.start + phase, options_.period * (1.0 + skew),
                       -std::numeric_limits<double>::infinity()});
  }
}

const SceneImage& Scene::next() {
  for (;;) {
    const auto clock = std::min_element(clocks_.begin(), clocks_.end(),
                                        [](auto& a, auto& b) { return a.next < b.next; });
    // What is exposed later arrives later than it is exposed.
    if (!on_the_way_.empty() && on_the_way_.front().image.arrival <= clock->next)
      break;
    expose(static_cast<std::size_t>(clock - clocks_.begin()));
  }
  std::pop_heap(on_the_way_.begin(), on_the_way_.end(), arrivesLater);
  std::swap(current_, on_the_way_.back());
  on_the_way_.pop_back();
  return current_;
}

void Scene::expose(std::size_t camera) {
  Clock& clock = clocks_[camera];
  SceneImage result;
  result.camera = camera;
  result.true_time = clock.next;
  clock.next += clock.period;
  result.image.maximum_spots = options_.maximum_spots;
  result.image.stamp = result.true_time + options_.stamp_noise * random_.gaussian();
  result.image.stamp_stddev = options_.stamp_noise;
  const double delay = std::max(0.0, options_.delay + options_.delay_jitter * random_.gaussian());
  result.image.arrival = std::max(result.true_time + delay, clock.last_arrival);
  clock.last_arrival = result.image.arrival;
  collectLights(camera, result.true_time);
  merge();
  std::stable_sort(lights_.begin(), lights_.end(), [&](auto& a, auto& b) {
    return options_.equally_bright ? isMerged(a.leds) > isMerged(b.leds) : a.distance < b.distance;
  });
  lights_.resize(std::min(lights_.size(), options_.maximum_spots));
  keepSlots(camera, &result);
  if (random_.uniform(0.0, 1.0) < options_.lost_images)
    return;
  on_the_way_.push_back(std::move(result));
  std::push_heap(on_the_way_.begin(), on_the_way_.end(), arrivesLater);
}

void Scene::collectLights(std::size_t camera_index, double time) {
  const geometry::Camera& camera = rig_.cameras[camera_index].camera;
  lights_.clear();
  const auto add = [&](Eigen::Vector2d pixel, double distance, std::uint64_t leds) {
    pixel += options_.pixel_noise * Eigen::Vector2d(random_.gaussian(), random_.gaussian());
    if (options_.integer_pixels)
      pixel = pixel.array().round();
    if (camera.intrinsics.isInImage(pixel))
      lights_.push_back({pixel, distance, leds});
  };
  for (std::size_t led = 0; led < leds_.size(); ++led) {
    const Eigen::Vector3d place = leds_[led](time);
    const double distance = (place - camera.center()).norm();
    const auto pixel = camera.project(place);
    const bool dropped = random_.uniform(0.0, 1.0) < options_.dropout;
    if (!pixel || distance > options_.range || dropped)
      continue;
    if (options_.hidden && options_.hidden(camera_index, led, time))
      continue;
    add(*pixel, distance, std::uint64_t{1} << led);
  }
  if (camera_index < options_.reflections.size()) {
    for (const Eigen::Vector2d& pixel : options_.reflections[camera_index])
      add(pixel, random_.uniform(2.0, 10.0), 0);
  }
  if (random_.uniform(0.0, 1.0) < options_.ghosts) {
    const double u = random_.uniform(0.0, camera.intrinsics.width - 1.0);
    add({u, random_.uniform(0.0, camera.intrinsics.height - 1.0)}, random_.uniform(2.0, 10.0), 0);
  }
}

/// Merges the closest two first, until all are far enough apart.
void Scene::merge() {
  for (;;) {
    double closest = options_.merging_distance;
    std::size_t a = 0;
    std::size_t b = 0;
    for (std::size_t i = 0; i < lights_.size(); ++i) {
      for (std::size_t j = i + 1; j < lights_.size(); ++j) {
        const double distance = (lights_[i].pixel - lights_[j].pixel).norm();
        if (distance < closest) {
          closest = distance;
          a = i;
          b = j;
        }
      }
    }
    if (b == 0)
      return;
    lights_[a].pixel = 0.5 * (lights_[a].pixel + lights_[b].pixel);
    if (options_.integer_pixels)
      lights_[a].pixel = lights_[a].pixel.array().round();
    lights_[a].distance = std::min(lights_[a].distance, lights_[b].distance);
    lights_[a].leds |= lights_[b].leds;
    lights_.erase(lights_.begin() + static_cast<std::ptrdiff_t>(b));
  }
}

/// A known light keeps its slot in the report; a new one takes the first free slot.
void Scene::keepSlots(std::size_t camera, SceneImage* image) {
  std::vector<std::uint64_t>& slots = slots_[camera];
  slots.resize(options_.maximum_spots);
  std::vector<const Light*> placed(options_.maximum_spots);
  for (const Light& light : lights_) {
    for (std::size_t slot = 0; light.leds && slot < slots.size(); ++slot) {
      if (!placed[slot] && (slots[slot] & light.leds)) {
        placed[slot] = &light;
        break;
      }
    }
  }
  for (const Light& light : lights_) {
    if (std::find(placed.begin(), placed.end(), &light) == placed.end())
      *std::find(placed.begin(), placed.end(), nullptr) = &light;
  }
  for (std::size_t slot = 0; slot < placed.size(); ++slot) {
    slots[slot] = placed[slot] ? placed[slot]->leds : 0;
    if (!placed[slot])
      continue;
    Spot spot;
    spot.pixel = placed[slot]->pixel;
    spot.slot = static_cast<int>(slot);
    image->image.spots.push_back(spot);
    image->leds_of_spot.push_back(placed[slot]->leds);
  }
}

}  // namespace wiimote_tracker::tracking::test
