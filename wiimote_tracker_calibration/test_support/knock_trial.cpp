#include "knock_trial.h"

#include "wave_trial.h"
#include "waved_led.h"

#include "continuous/continuous_calibration.h"
#include "health/led_selection.h"

#include <Eigen/Geometry>

#include <optional>
#include <set>

namespace wiimote_tracker {

namespace {

constexpr double kBefore = 20.0;  // [s]
constexpr double kAfter = 60.0;   // [s]

/// Two cameras after a shelf on which they stand was turned.
void turnTogether(double angle,
                  square::Random& random,
                  geometry::RigCamera* a,
                  geometry::RigCamera* b) {
  const Eigen::Vector3d middle = (a->camera.center() + b->camera.center()) / 2.0;
  const Eigen::Isometry3d turn = Eigen::Translation3d(middle) *
                                 Eigen::AngleAxisd(angle, square::anyDirection(random)) *
                                 Eigen::Translation3d(-middle);
  for (geometry::RigCamera* const camera : {a, b})
    camera->camera.world_from_camera = turn * camera->camera.world_from_camera;
}

/// Cameras whose poses differ.
std::set<std::size_t> changedCameras(const geometry::Rig& before, const geometry::Rig& now) {
  std::set<std::size_t> changed;
  for (std::size_t i = 0; i < now.cameras.size(); ++i) {
    if (before.cameras[i].camera.world_from_camera.matrix() !=
        now.cameras[i].camera.world_from_camera.matrix())
      changed.insert(i);
  }
  return changed;
}

}  // namespace

KnockTrial runKnockTrial(const Knock& knock, std::uint64_t seed) {
  square::Random random(seed + 5000);
  geometry::Rig rig = paperRigWith(wellCalibrated(), knock.cameras);
  WavedLed led(drawTruth(rig, random), seed + 6000);
  led.shine(knock.leds, knock.on_body);
  if (knock.leds > 1) {
    led.hidden = 0.1;
    led.ghosts = 0.05;
    led.wrong_share = 0.0;
  }
  std::optional<health::LedSelection> selection(rig);
  std::optional<continuous::ContinuousCalibration> watch;
  watch.emplace(rig, continuous::Options{});
  KnockTrial trial;
  std::set<std::size_t> missing;  // Knocked cameras that were not yet found.
  double last_knock = kBefore;
  const auto runUntil = [&](double time) {
    led.runUntil(time, [&](const capture::Image& image) {
      const auto proposal = trial.found ? std::nullopt : watch->add(selection->select(image));
      if (!proposal || proposal->cause == continuous::Cause::kDrift)
        return;
      for (const std::size_t i : changedCameras(rig, proposal->rig))
        trial.others = missing.erase(i) == 0 || trial.others;
      trial.found = missing.empty() && image.stamp > WavedLed::kClock + last_knock;
      trial.seconds = image.stamp - WavedLed::kClock - last_knock;
      rig = proposal->rig;
      selection.emplace(rig);
      watch.emplace(rig, continuous::Options{});
    });
  };
  runUntil(kBefore);
  const std::size_t first = seed % knock.cameras;
  const std::size_t second =
      (first + 1 + seed / knock.cameras % (knock.cameras - 1)) % knock.cameras;
  last_knock = kBefore + knock.pause * static_cast<double>(knock.knocked - 1);
  missing.insert(first);
  if (knock.together)
    turnTogether(knock.turn, random, &led.truth[first], &led.truth[second]);
  else
    led.truth[first] = turned(led.truth[first], knock.turn, random);
  runUntil(last_knock);
  if (knock.knocked > 1) {
    missing.insert(second);
    if (!knock.together)
      led.truth[second] = turned(led.truth[second], knock.turn, random);
  }
  runUntil(last_knock + (knock.on_body ? 2.0 : 1.0) * kAfter);
  trial.error = wave::volumeError(led.truth, rig);
  return trial;
}

}  // namespace wiimote_tracker
