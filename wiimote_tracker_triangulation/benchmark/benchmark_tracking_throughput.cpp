#include "benchmark_sections.h"
#include "tracking/scene.h"
#include "wiimote_tracker_triangulation/tracking/tracker.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>

namespace wiimote_tracker {
namespace {

using namespace tracking;
using namespace tracking::test;

struct Timing {
  double seconds = 0.0;  // CPU time
  double images = 0.0;
  double snapshots = 0.0;
  double leds = 0.0;  // confirmed in the last snapshot
};

/// Images are simulated in batches; only the tracker's work is timed.
Timing timed(const geometry::Rig& rig,
             const std::vector<Path>& leds,
             const SceneOptions& options,
             const TrackerOptions& tracker_options,
             int batches,
             unsigned seed) {
  constexpr std::size_t kBatch = 4000;
  Scene scene(rig, leds, options, seed);
  Tracker tracker(rig, tracker_options);
  std::vector<SceneImage> batch(kBatch);
  Timing timing;
  for (int i = 0; i <= batches; ++i) {  // the first warms up
    for (SceneImage& image : batch)
      image = scene.next();
    const double start = processorTime();
    for (const SceneImage& image : batch) {
      tracker.add(image.camera, image.image);
      while (const Snapshot* snapshot = tracker.next()) {
        timing.snapshots += i > 0;
        timing.leds = static_cast<double>(
            std::count_if(snapshot->leds.begin(), snapshot->leds.end(),
                          [](auto& led) { return led.state == TrackState::kTracked; }));
      }
    }
    timing.seconds += i > 0 ? processorTime() - start : 0.0;
  }
  timing.images = static_cast<double>(kBatch) * batches;
  return timing;
}

SceneOptions sceneOptions() {
  SceneOptions options;
  options.clock_skew = 1e-4;
  return options;
}

std::vector<Path> ledsIn(geometry::test::Random& random, const Eigen::Vector3d& middle) {
  std::vector<Path> leds;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d offset(i % 2 ? 0.5 : -0.5, i / 2 ? 0.5 : -0.5, 0.0);
    leds.push_back(wandering(random, middle + offset, 0.25, 1.0));
  }
  return leds;
}

void runThroughput(const BenchmarkSettings& settings, const RowCallback& row) {
  geometry::test::Random random(settings.seed);
  std::vector<Path> leds = ledsIn(random, {1.25, 1.25, 1.0});
  const auto add = [&](const char* name, const SceneOptions& options, const geometry::Rig& rig) {
    const Timing timing = timed(rig, leds, options, exactOptions(), settings.runs, settings.seed);
    row({name,
         {{"images", timing.images},
          {"us/image", 1e6 * timing.seconds / timing.images},
          {"sets/s", timing.images / 4.0 / timing.seconds},
          {"snapshots", timing.snapshots},
          {"leds", timing.leds}}});
  };
  SceneOptions options = sceneOptions();
  add("images in order", options, paperRig());
  options.dropout = 0.1;
  options.ghosts = 1.0;
  add("10 % dropouts, a ghost in each", options, paperRig());
  options = sceneOptions();
  options.delay_jitter = 0.0024;
  add("delays of 2.4 ms jitter: late images", options, paperRig());
  leds = ledsIn(random, {0.0, 0.0, 1.0});
  add("these, 32 cameras around the LEDs", options, roomsRig(1, 32));
  add("these, 64 cameras around the LEDs", options, roomsRig(1, 64));
}

void runScale(const BenchmarkSettings& settings, const RowCallback& row) {
  for (const int rooms : {1, 4, 16}) {
    geometry::test::Random random(settings.seed);
    std::vector<Path> leds;
    for (int room = 0; room < rooms; ++room) {
      for (const Path& led : ledsIn(random, {100.0 * room, 0.0, 1.0}))
        leds.push_back(led);
    }
    SceneOptions options = sceneOptions();
    options.delay_jitter = 0.0024;
    const Timing timing =
        timed(roomsRig(rooms, 4), leds, options, exactOptions(), settings.runs, settings.seed);
    const double seconds = timing.images / (400.0 * rooms);  // simulated
    row({format("%d cameras, %d LEDs, %d rooms", 4 * rooms, 4 * rooms, rooms),
         {{"images", timing.images},
          {"us/image", 1e6 * timing.seconds / timing.images},
          {"load", timing.seconds / seconds},
          {"snapshots/s", timing.snapshots / seconds},
          {"leds", timing.leds}}});
  }
}

}  // namespace

BenchmarkSection throughputSection() {
  return {"throughput",
          "four LEDs at 1 m/s in the paper's rig, one core, 4000 images per run; processor time "
          "of the tracker alone, snapshots with it.\n"
          "Images; time per image [us]; sets of four images per second; snapshots; LEDs tracked "
          "at the end.",
          runThroughput};
}

BenchmarkSection scaleSection() {
  return {"scale",
          "rooms with four cameras and four LEDs at 1 m/s each, 100 images per second and camera, "
          "delays of 2.4 ms jitter, 4000 images per run.\n"
          "Images; processor time per image [us]; load of one core in real time [1]; snapshots, "
          "of all LEDs, per second; LEDs tracked at the end.",
          runScale};
}

}  // namespace wiimote_tracker
