// The error that unsynchronised cameras and uncertain stamps cause.
#include "benchmark_sections.h"
#include "tracking/paths.h"
#include "tracking/scene.h"
#include "wiimote_tracker_triangulation/estimators/make_estimator.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker {
namespace {

using Eigen::Vector3d;
using estimators::TrackerMode;
using tracking::test::Path;
using tracking::test::SceneImage;

constexpr double kDuration = 10.0;  // of a run [s]
constexpr double kWarmUp = 0.5;     // errors before are not scored, after the first image [s]
constexpr double kDelay = 0.0112;   // from exposure to arrival, mean [s]
constexpr double kJitter = 0.0024;  // of that, standard deviation [s]

/// The errors of the stamps.
struct Stamping {
  const char* name;
  double offset;  // constant of each camera, standard deviation [s]
  double noise;   // of each image, standard deviation [s]
  bool arrival;   // the stamp is the arrival less the mean delay instead
};

/// Errors at the times of the snapshots.
struct Errors {
  double squared = 0.0;
  int count = 0;
  int snapshots = 0;

  double rms() const { return std::sqrt(squared / count); }
};

/// Images in the order of arrival.
std::vector<SceneImage> recording(const Path& path, const Stamping& stamping, unsigned seed) {
  tracking::test::SceneOptions options;
  options.clock_skew = 0.0005;
  options.pixel_noise = 0.5;
  options.lost_images = 0.04;
  options.delay = kDelay;
  options.delay_jitter = kJitter;
  const geometry::Rig rig = tracking::test::paperRig();
  tracking::test::Scene scene(rig, {path}, options, seed);
  geometry::test::Random random(seed + 1000);
  std::vector<double> offsets;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i)
    offsets.push_back(stamping.offset * random.gaussian());
  std::vector<SceneImage> images;
  while (true) {
    SceneImage image = scene.next();
    if (image.true_time > options.start + kDuration)
      return images;
    if (stamping.arrival) {
      image.image.stamp = image.image.arrival - kDelay;
      image.image.stamp_stddev = kJitter;
    } else {
      image.image.stamp =
          image.true_time + offsets[image.camera] + stamping.noise * random.gaussian();
      image.image.stamp_stddev = std::hypot(stamping.offset, stamping.noise);
    }
    images.push_back(image);
  }
}

void track(const std::vector<SceneImage>& images,
           const Path& path,
           TrackerMode mode,
           Errors* errors) {
  estimators::EstimatorOptions options;
  options.tracker_mode = mode;
  const auto estimator = estimators::makeEstimator(tracking::test::paperRig(), options);
  for (const SceneImage& image : images) {
    estimator->add(image.camera, image.image);
    while (const tracking::Snapshot* snapshot = estimator->next()) {
      if (snapshot->time < images.front().true_time + kWarmUp)
        continue;
      ++errors->snapshots;
      // The nearest track; false tracks are not counted here.
      double least = std::numeric_limits<double>::infinity();
      const Vector3d truth = path(snapshot->time);
      for (const tracking::TrackedLed& led : snapshot->leds)
        least = std::min(least, (led.position - truth).squaredNorm());
      if (!std::isfinite(least))
        continue;
      errors->squared += least;
      ++errors->count;
    }
  }
}

void runUnsynchronised(const BenchmarkSettings& settings, const RowCallback& row) {
  const Stamping stampings[] = {{"exact stamps", 0.0, 0.0, false},
                                {"stamps off by 0.2 ms", 1.4e-4, 1.4e-4, false},
                                {"arrival stamps, 2.4 ms of jitter", 0.0, 0.0, true}};
  for (const double speed : {1.0, 2.0, 3.0}) {
    double exact = std::numeric_limits<double>::quiet_NaN();
    for (const Stamping& stamping : stampings) {
      Errors tracks, instants;
      for (int i = 0; i < settings.runs; ++i) {
        const Path path = tracking::test::circle({1.25, 1.25, 1.2}, 0.75, speed, 0.3 * i);
        const std::vector<SceneImage> images = recording(path, stamping, settings.seed + i);
        track(images, path, TrackerMode::kTracks, &tracks);
        track(images, path, TrackerMode::kInstant, &instants);
      }
      if (std::isnan(exact))
        exact = tracks.rms();
      const std::string name = format("%.0f m/s, %s", speed, stamping.name);
      row({name,
           {{"RMS mm", 1e3 * tracks.rms()},
            {"ratio", tracks.rms() / exact},
            {"seen %", 100.0 * tracks.count / tracks.snapshots},
            {"instant mm", 1e3 * instants.rms()},
            {"inst ratio", instants.rms() / exact},
            {"inst seen %", 100.0 * instants.count / instants.snapshots}}});
    }
  }
}

}  // namespace

BenchmarkSection unsynchronisedSection() {
  return {"unsynchronised",
          "an LED on a circle of 0.75 m seen by four cameras, each on its own clock (period 10 ms, "
          "0.5 per mille apart), 0.5 px of noise, 4 % of the images lost, 11 ms of delay: tracks, "
          "then the paper's method (interpolated to an instant, intersected). Ratio: RMS over that "
          "of the tracks with exact stamps. Half of the variance of a stamp's error is constant "
          "for each camera.",
          runUnsynchronised};
}

}  // namespace wiimote_tracker
