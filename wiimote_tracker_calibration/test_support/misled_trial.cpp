#include "misled_trial.h"

#include "wave_trial.h"
#include "waved_led.h"

#include "continuous/continuous_calibration.h"
#include "health/led_selection.h"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker {

namespace {

constexpr double kMisledDuration = 45.0;  // [s]
constexpr double kMisledPeriod = 10.0;    // of which a camera is misled for a share [s]
constexpr double kImageRate = 40.0;       // of the images [Hz]
constexpr double kEmpty = 0.95;           // Share of the images without a false detection.

/// Lights that move with the LEDs: of an LED's position at a time shifted by `delay`, its
/// coordinates times `scale` plus `offset`.
struct Light {
  bool masked = false;  // No light at all.
  double delay = 0.0;   // [s]
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  // [m]

  std::vector<Eigen::Vector3d> at(const WavedLed& leds, double time) const {
    std::vector<Eigen::Vector3d> lights;
    for (const Eigen::Vector3d& led : leds.places(time + delay))
      lights.emplace_back(led.cwiseProduct(scale) + offset);
    return lights;
  }
};

Eigen::Vector3d anyPlace(square::Random& random) {
  return {square::uniform(random, 0.0, 2.5), square::uniform(random, 0.0, 2.5),
          square::uniform(random, 0.0, 2.5)};
}

Light lightOf(Misled by, square::Random& random) {
  Light light;
  switch (by) {
    case Misled::kMirror: {
      const int axis = static_cast<int>(square::uniform(random, 0.0, 2.999));
      const bool is_far = axis < 2 && square::uniform(random, 0.0, 1.0) < 0.5;
      const double wall = is_far ? square::uniform(random, 2.5, 4.0)
                                 : square::uniform(random, axis == 2 ? -0.1 : -1.5, 0.0);
      light.scale[axis] = -1.0;
      light.offset[axis] = 2.0 * wall;
      return light;
    }
    case Misled::kOtherLed:
      light.delay = square::uniform(random, 1.0, 20.0);
      return light;
    case Misled::kCarried:
      light.offset = square::uniform(random, 0.25, 0.6) *
                     (anyPlace(random) - Eigen::Vector3d::Constant(1.25)).normalized();
      return light;
    case Misled::kLamp:
      light.scale.setZero();
      light.offset = anyPlace(random);
      return light;
    case Misled::kMasked:
    case Misled::kTwoLights:
      break;
  }
  light.masked = true;
  return light;
}

Misled anyLight(square::Random& random) {
  const Misled kLights[] = {Misled::kMirror, Misled::kOtherLed, Misled::kCarried, Misled::kLamp};
  return kLights[static_cast<std::size_t>(square::uniform(random, 0.0, 3.999))];
}

}  // namespace

MisledTrial runMisledTrial(Misled by, std::uint64_t seed, std::size_t leds, bool on_body) {
  square::Random random(seed);
  geometry::Rig rig = paperRigWith(wellCalibrated());
  rig.solved_at = WavedLed::kClock;
  WavedLed led(drawTruth(rig, random), seed + 1, kImageRate);
  led.shine(leds, on_body);
  const bool two_lights = by == Misled::kTwoLights;
  const Light light = lightOf(two_lights ? anyLight(random) : by, random);
  const Light other_light = two_lights ? lightOf(anyLight(random), random) : light;
  const auto any = static_cast<std::size_t>(square::uniform(random, 0.0, 3.999));
  const std::size_t next = two_lights ? (any + 1 + seed % 3) % 4 : (any + 1) % 4;
  // What each misled camera sees.
  std::map<std::string, Light> misled = {{led.truth[any].camera.name, light}};
  if (two_lights || square::uniform(random, 0.0, 1.0) < 0.3)
    misled.emplace(led.truth[next].camera.name, other_light);
  const bool always = square::uniform(random, 0.0, 1.0) < 0.5;
  const double share = always ? 1.0 : square::uniform(random, 0.2, 1.0);

  MisledTrial trial;
  const double before = wave::volumeError(led.truth, rig);
  std::optional<health::LedSelection> selection(rig);
  std::optional<continuous::ContinuousCalibration> watch;
  watch.emplace(rig, continuous::Options{});
  led.runUntil(kMisledDuration, [&](capture::Image image) {
    const geometry::RigCamera& camera =
        led.truth[static_cast<std::size_t>(rig.find(image.camera) - rig.cameras.data())];
    const double time = image.stamp - WavedLed::kClock + camera.time_offset;
    const auto seen = misled.find(image.camera);
    if (seen != misled.end() && std::fmod(time, kMisledPeriod) < share * kMisledPeriod) {
      image.spots.clear();
      const Light& light_seen = seen->second;
      for (const Eigen::Vector3d& place : light_seen.at(led, time)) {
        const auto pixel = light_seen.masked ? std::nullopt : camera.camera.project(place);
        if (pixel)
          WavedLed::addSpot(*pixel, &image.spots);
      }
    }
    const auto proposal = watch->add(selection->select(image));
    if (!proposal)
      return;
    rig = proposal->rig;
    selection.emplace(rig);
    watch.emplace(rig, continuous::Options{});
    ++trial.changes;
  });
  trial.worse = wave::volumeError(led.truth, rig) - before;
  return trial;
}

int changesAtRest(bool with_led, int seconds, std::uint64_t seed) {
  square::Random random(seed);
  const geometry::Rig rig = paperRigWith(wellCalibrated());
  WavedLed led(drawTruth(rig, random), seed + 1);
  led.still = Eigen::Vector3d(1.0, 1.1, 0.9);
  if (!with_led)
    led.wrong_share = 1.0;
  continuous::ContinuousCalibration watch(rig, {});
  int changes = 0;
  for (int hour = 0; hour < 24; ++hour) {
    led.skipTo(3600.0 * hour);
    led.runUntil(3600.0 * hour + seconds, [&](capture::Image image) {
      if (!with_led && square::uniform(random, 0.0, 1.0) < kEmpty)
        image.spots.clear();
      changes += watch.add(image) ? 1 : 0;
    });
  }
  return changes;
}

}  // namespace wiimote_tracker
