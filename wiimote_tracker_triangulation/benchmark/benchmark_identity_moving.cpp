// Blinking LEDs, followed by the tracker as they move.
#include "benchmark_sections.h"
#include "identity/blinking.h"
#include "tracking/scene.h"
#include "wiimote_tracker_triangulation/identity/blink_codes.h"
#include "wiimote_tracker_triangulation/identity/schemes.h"
#include "wiimote_tracker_triangulation/identity/snapshot_sightings.h"
#include "wiimote_tracker_triangulation/tracking/tracker.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace wiimote_tracker {
namespace {

using namespace identity;
using geometry::test::Random;
using tracking::test::Path;
using tracking::test::Scene;
using tracking::test::SceneOptions;

constexpr double kSecondsPerRun = 1.0;
constexpr double kNear = 0.1;  // largest distance of a track from its LED [m]

struct Kind {
  std::string name;
  BlinkCodes codes;
  double period;  // [s]; 0: the LEDs do not blink
};

std::vector<Path> pathsOf(double speed, unsigned seed) {
  Random random(seed);
  std::vector<Path> paths;
  for (const Eigen::Vector3d& center :
       {Eigen::Vector3d(0.8, 0.8, 1.2), Eigen::Vector3d(1.7, 0.8, 1.2),
        Eigen::Vector3d(0.8, 1.7, 1.2), Eigen::Vector3d(1.7, 1.7, 1.2)}) {
    paths.push_back(speed == 0.0 ? tracking::test::still(center)
                                 : tracking::test::wandering(random, center, 0.4, speed));
  }
  return paths;
}

struct Result {
  double led_time = 0.0;       // LEDs in snapshots
  double followed = 0.0;       // of these, with a track near
  double labelled = 0.0;       // of these, with a label
  double wrong = 0.0;          // of these, with another LED's label
  double squared = 0.0;        // errors of position [m^2]
  double decided_after = 0.0;  // from a track's first image to its label, summed [s]
  double decisions = 0.0;
  std::size_t tracks = 0;
};

void score(const tracking::Snapshot& snapshot,
           const std::vector<Path>& leds,
           const Identifier& identifier,
           std::map<std::uint32_t, double>* decided,
           Result* result) {
  for (std::size_t led = 0; led < leds.size(); ++led) {
    const Eigen::Vector3d truth = leds[led](snapshot.time);
    ++result->led_time;
    const tracking::TrackedLed* nearest = nullptr;
    for (const tracking::TrackedLed& track : snapshot.leds) {
      if (track.state != tracking::TrackState::kTentative &&
          track.state != tracking::TrackState::kLost &&
          (track.position - truth).norm() < (nearest ? (nearest->position - truth).norm() : kNear))
        nearest = &track;
    }
    if (!nearest)
      continue;
    ++result->followed;
    result->squared += (nearest->position - truth).squaredNorm();
    const Identity* identity = identifier.identityOf(nearest->id);
    if (!identity || !identity->label)
      continue;
    ++result->labelled;
    result->wrong += *identity->label != led;
    if (decided->emplace(nearest->id, identity->since).second) {
      result->decided_after += identity->since - nearest->first_seen;
      ++result->decisions;
    }
  }
}

Result simulate(const Kind& kind, double speed, const BenchmarkSettings& settings) {
  const std::vector<Path> leds = pathsOf(speed, settings.seed);
  Random random(settings.seed);
  std::vector<double> phases;
  const double common = random.uniform(0.0, 1.0);
  for (std::size_t led = 0; led < leds.size(); ++led)
    phases.push_back(kind.codes.synchronous ? common : random.uniform(0.0, 1.0));
  constexpr double kExposure = 0.001;
  SceneOptions options;
  options.clock_skew = 1e-4;
  options.dropout = 0.05;
  options.ghosts = 0.02;
  options.merging_distance = 8.0;
  options.stamp_noise = 0.0005;
  options.hidden = [&](std::size_t, std::size_t led, double time) {
    if (kind.period == 0.0)
      return false;
    const double begin = (time - 1000.0 - 0.5 * kExposure) / kind.period + phases[led];
    return litShare(kind.codes.codes[led].waveform, begin, kExposure / kind.period) < 0.5;
  };
  const geometry::Rig rig = tracking::test::paperRig();
  Scene scene(rig, leds, options, settings.seed);
  tracking::TrackerOptions tracker_options;
  if (kind.period > 0.0)
    tracker_options = forBlinking(kind.codes, tracker_options);
  tracking::Tracker tracker(rig, tracker_options);
  Identifier identifier(kind.codes, {});
  SnapshotSightings sightings({});
  std::map<std::uint32_t, double> decided;
  Result result;
  std::uint32_t highest = 0;
  while (true) {
    const tracking::test::SceneImage& image = scene.next();
    if (image.true_time > options.start + kSecondsPerRun * settings.runs)
      break;
    tracker.add(image.camera, image.image);
    while (const tracking::Snapshot* snapshot = tracker.next()) {
      sightings.add(rig, *snapshot, &identifier);
      score(*snapshot, leds, identifier, &decided, &result);
      for (const tracking::TrackedLed& led : snapshot->leds) {
        if (led.state == tracking::TrackState::kTracked)
          highest = std::max(highest, led.id + 1);
      }
    }
  }
  result.tracks = highest;
  return result;
}

void runMoving(const BenchmarkSettings& settings, const RowCallback& row) {
  const BlinkCodes cyclic = identity::test::fourWords(0.001);
  const BlinkCodes paper = identity::test::paperCodes(0.11, 0.25);
  for (const Kind& kind : {Kind{"steady", cyclic, 0.0}, Kind{"cyclic", cyclic, 0.184},
                           Kind{"paper, 150 ms", paper, 0.15}}) {
    for (const double speed : {0.0, 0.3, 1.0}) {
      const Result result = simulate(kind, speed, settings);
      const std::string name = format("%s, %.1f m/s", kind.name.c_str(), speed);
      BenchmarkRow figures{name,
                           {{"followed %", 100.0 * result.followed / result.led_time},
                            {"tracks", result.tracks},
                            {"RMS mm", 1e3 * std::sqrt(result.squared / result.followed)}}};
      if (kind.period > 0.0) {
        figures.figures.push_back({"labelled %", 100.0 * result.labelled / result.led_time});
        figures.figures.push_back({"wrong %", 100.0 * result.wrong / result.led_time});
        figures.figures.push_back({"label after s", result.decided_after / result.decisions});
      }
      row(figures);
    }
  }
}

}  // namespace

BenchmarkSection movingSection() {
  return {"moving",
          "four LEDs in the paper's rig, tracked; 0.3 px, 5 % missed detections, a false detection "
          "in 2 % of the images; 1 s per --runs. Shares of LEDs times snapshots with a track "
          "within 10 cm; tracks in all (4 at best); RMS error; shares with a label, with another "
          "LED's label; mean time from a track's first image to its label. steady: no LED blinks.",
          runMoving};
}

}  // namespace wiimote_tracker
