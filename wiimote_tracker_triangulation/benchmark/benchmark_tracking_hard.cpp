// The accuracy of random motion, from slow to hard, with unsynchronised cameras.
#include "benchmark_sections.h"
#include "geometry/accuracy.h"
#include "motion/smoother.h"
#include "tracking/paths.h"
#include "tracking/scene.h"
#include "wiimote_tracker_triangulation/estimators/make_estimator.h"

#include <wiimote_tracker_msgs/text.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace wiimote_tracker {
namespace {

using estimators::TrackerMode;
using geometry::test::Accuracy;
using tracking::test::Path;
using tracking::test::SceneImage;

constexpr double kRun = 8.0;         // [s]
constexpr double kStartOfRun = 0.5;  // errors before are not scored [s]

std::vector<SceneImage> filmHard(const geometry::Rig& rig, const Path& path, unsigned seed) {
  tracking::test::SceneOptions options;
  options.clock_skew = 0.0005;
  options.pixel_noise = 0.5;
  tracking::test::Scene scene(rig, {path}, options, seed);
  std::vector<SceneImage> images;
  while (images.empty() || images.back().true_time < options.start + kRun)
    images.push_back(scene.next());
  return images;
}

/// What is known of an LED.
struct Track {
  std::vector<motion::Observation> observations;
  std::vector<motion::Place> places;
};

/// @returns where the straight line through the last two places is at this time.
Eigen::Vector3d extended(const std::vector<motion::Place>& places, double time) {
  const motion::Place& last = places.back();
  const motion::Place& before = places[places.size() - 2];
  return last.position +
         (time - last.time) / (last.time - before.time) * (last.position - before.position);
}

/// Errors of points.
struct HardErrors {
  Accuracy own;        ///< At the points' own times.
  Accuracy at_newest;  ///< At the time of the newest image: the last two points, extended in a
                       ///< straight line. Only its RMS has a meaning.
};

/// @returns the tracks by id.
std::map<std::uint32_t, Track> trackHard(const geometry::Rig& rig,
                                         const std::vector<SceneImage>& images,
                                         const Path& path,
                                         const estimators::EstimatorOptions& options,
                                         HardErrors* errors) {
  std::map<std::uint32_t, Track> tracks;
  const auto estimator = estimators::makeEstimator(rig, options);
  for (const SceneImage& image : images) {
    estimator->add(image.camera, image.image);
    while (const tracking::Snapshot* snapshot = estimator->next()) {
      for (const tracking::SeenSpot& spot : snapshot->views[image.camera].spots) {
        if (spot.use == tracking::SpotUse::kAssigned)
          tracks[spot.led].observations.push_back({snapshot->time,
                                                   &rig.cameras[image.camera].camera,
                                                   spot.pixel,
                                                   {options.tracks.pixel_stddev, 0.0}});
      }
      for (const tracking::TrackedLed& led : snapshot->leds) {
        if (led.state != tracking::TrackState::kTracked)
          continue;
        auto& places = tracks[led.id].places;
        places.push_back({snapshot->time, led.position});
        if (snapshot->time < images.front().true_time + kStartOfRun || places.size() < 2)
          continue;
        errors->own.add(led.position - path(snapshot->time), led.position_covariance);
        errors->at_newest.add(extended(places, image.true_time) - path(image.true_time),
                              Eigen::Matrix3d::Identity());
      }
    }
  }
  return tracks;
}

void smooth(const std::map<std::uint32_t, Track>& tracks,
            const std::vector<SceneImage>& images,
            const Path& path,
            Accuracy* errors) {
  const double start = images.front().true_time + kStartOfRun;
  const double end = images.back().true_time - kStartOfRun;
  for (const auto& [id, track] : tracks) {
    const auto states = motion::smooth(motion::MotionOptions(), track.observations, track.places);
    for (std::size_t i = 0; i < states.size(); ++i) {
      const double time = track.places[i].time;
      if (time > start && time < end)
        errors->add(states[i].position() - path(time), states[i].positionCovariance());
    }
  }
}

/// One Singer mode that suits the motion: with its acceleration per axis, and the autocorrelation
/// time that was found best by a scan.
motion::MotionOptions singleMode(double speed, double acceleration) {
  motion::MotionOptions options;
  options.moving.fill({acceleration / std::sqrt(3.0), 2.0 * speed / acceleration});
  options.sudden_random_walk = options.stop_rate = 0.0;
  return options;
}

void runHard(const BenchmarkSettings& settings, const RowCallback& row) {
  constexpr std::pair<double, double> kMotions[] = {
      {0.05, 0.1}, {0.2, 0.5},  {0.5, 2.0},  {1.0, 6.0},  {1.5, 10.0},
      {2.0, 8.0},  {2.0, 17.0}, {3.0, 12.0}, {3.0, 25.0}, {3.0, 38.0}};
  for (const std::size_t cameras : {4, 2}) {
    geometry::Rig rig = tracking::test::paperRig();
    rig.cameras.resize(cameras);
    for (const auto& [speed, acceleration] : kMotions) {
      HardErrors tracks, singles, instants;
      Accuracy smoothed;
      estimators::EstimatorOptions default_options, single, instant;
      single.tracks.motion = singleMode(speed, acceleration);
      instant.tracker_mode = TrackerMode::kInstant;
      for (int i = 0; i < settings.runs; ++i) {
        geometry::test::Random random(settings.seed + i);
        const Path path = tracking::test::shaken(random, {1.25, 1.25, 1.2}, speed, acceleration);
        const std::vector<SceneImage> images = filmHard(rig, path, settings.seed + i);
        smooth(trackHard(rig, images, path, default_options, &tracks), images, path, &smoothed);
        trackHard(rig, images, path, single, &singles);
        trackHard(rig, images, path, instant, &instants);
      }
      row({format("%zu cameras, %.2f m/s, %.1f m/s^2", cameras, speed, acceleration),
           {{"RMS mm", 1e3 * tracks.own.rms()},
            {"NEES", tracks.own.nees()},
            {"in 95 %", 100.0 * tracks.own.shareInside()},
            {"single mm", 1e3 * singles.own.rms()},
            {"instant mm", 1e3 * instants.own.rms()},
            {"ratio", tracks.own.rms() / instants.own.rms()},
            {"extended mm", 1e3 * instants.at_newest.rms()},
            {"ratio at once", tracks.own.rms() / instants.at_newest.rms()},
            {"smooth mm", 1e3 * smoothed.rms()},
            {"NEES ", smoothed.nees()},
            {"in 95 % ", 100.0 * smoothed.shareInside()}}});
    }
  }
}

}  // namespace

BenchmarkSection hardSection() {
  return {"hard",
          "random motion (five sine waves per axis) of this RMS speed and acceleration, "
          "unsynchronised cameras (period 10 ms), exact stamps, 0.5 px of noise: tracks; tracks "
          "with one mode that suits the row; the paper's method, whose points are up to 10 ms "
          "older; ratio of the tracks' RMS to that; its last two points, extended to the tracks' "
          "time; ratio to that; smoothed tracks.",
          runHard};
}

}  // namespace wiimote_tracker
