#include "benchmark_sections.h"
#include "led_meeting.h"
#include "tracking/identity_check.h"
#include "tracking/scene.h"
#include "wiimote_tracker_triangulation/tracking/tracker.h"

#include <cstdint>
#include <vector>

namespace wiimote_tracker {
namespace {

using namespace tracking;
using namespace tracking::test;

constexpr double kMerging = 8.0;  // of the sensor; the tracker assumes its default [px]

BenchmarkRow timeRow(const std::string& name,
                     double speed,
                     double jitter,
                     int frames,
                     unsigned seed) {
  // Some view always resolves them. In single views they often pass and merge.
  const std::vector<Path> leds = wanderers(4, seed, speed);
  SceneOptions options;
  options.merging_distance = kMerging;
  options.dropout = 0.1;
  options.ghosts = 1.0;
  options.delay_jitter = jitter;
  options.clock_skew = 1e-4;
  const geometry::Rig rig = paperRig();
  Scene scene(rig, leds, options, seed);
  Tracker tracker(rig, exactOptions());
  IdentityCheck check(leds);
  constexpr int kWarmUp = 400;  // images until all are confirmed
  std::uint64_t uncovered_at_end = 0;
  for (int i = 0; i < frames; ++i) {
    const SceneImage& image = scene.next();
    tracker.add(image.camera, image.image);
    while (const Snapshot* snapshot = tracker.next()) {
      const std::uint64_t before = check.uncovered;
      if (i >= kWarmUp)
        check.add(*snapshot);
      uncovered_at_end = check.uncovered - before;
    }
  }
  return {name,
          {{"frames", frames},
           {"switches", check.switches},
           {"renamed", check.renamed},
           {"uncovered", check.uncovered},
           {"at_end", uncovered_at_end},
           {"false", check.false_tracks},
           {"rms_mm", 1e3 * check.rms()},
           {"late", tracker.counters().late}}};
}

BenchmarkRow meetingRow(const std::string& name,
                        const LedMeeting& meeting,
                        int wanted,
                        unsigned seed) {
  const geometry::Rig rig = paperRig();
  SceneOptions options;
  options.start = meeting.meeting_time - meeting.half_duration + 0.01;
  options.merging_distance = kMerging;
  geometry::test::Random random(seed);
  int meetings = 0;
  int left_out = 0;
  int oracle_errors = 0;
  int filter_errors = 0;
  int errors = 0;
  int renamed = 0;
  for (unsigned trial = 0; meetings < wanted; ++trial) {
    const std::vector<Path> leds = meeting.draw(random);
    Scene scene(rig, leds, options, seed + trial);
    Tracker tracker(rig, exactOptions());
    std::vector<SceneImage> images;
    std::vector<std::int64_t> before = {-1, -1};
    std::vector<std::int64_t> after = {-1, -1};
    const double end = meeting.meeting_time + meeting.half_duration - 0.01;
    while (images.empty() || images.back().true_time < end) {
      images.push_back(scene.next());
      tracker.add(images.back().camera, images.back().image);
      while (const Snapshot* snapshot = tracker.next()) {
        const auto ids = idsAt(*snapshot, leds, 0.1);
        const double apart = (leds[0](snapshot->time) - leds[1](snapshot->time)).norm();
        if (apart < 0.08)
          continue;
        (snapshot->time < meeting.meeting_time ? before : after) = ids;
      }
    }
    const auto oracle = oracleErrors(meeting, {rig, leds, images, options.pixel_noise});
    // Never merged in all views, or not resolved before: nothing to compare.
    if (!oracle || before[0] < 0 || before[1] < 0 || after[0] < 0 || after[1] < 0) {
      ++left_out;
      continue;
    }
    ++meetings;
    oracle_errors += oracle->with_model;
    filter_errors += oracle->with_filters;
    const bool exchanged = after[0] == before[1] || after[1] == before[0];
    errors += exchanged;
    renamed += !exchanged && (after[0] != before[0] || after[1] != before[1]);
  }
  return {name,
          {{"encounters", meetings},
           {"left_out", left_out},
           {"oracle", oracle_errors},
           {"with_filters", filter_errors},
           {"tracker", errors},
           {"renamed", renamed},
           {"ratio", static_cast<double>(errors + renamed) / oracle_errors}}};
}

void runIdentity(const BenchmarkSettings& settings, const RowCallback& row) {
  const int frames = 10000 * settings.runs;
  row(timeRow("0.5 m/s", 0.5, 0.0, frames, settings.seed));
  row(timeRow("1 m/s", 1.0, 0.0, frames, settings.seed + 1));
  row(timeRow("2 m/s", 2.0, 0.0, frames, settings.seed + 2));
  row(timeRow("1 m/s, late images", 1.0, 0.0024, frames, settings.seed + 3));
  const int meetings = 20 * settings.runs;
  LedMeeting meeting;
  for (const double speed : {0.2, 0.5, 1.0}) {
    for (const double acceleration : {2.0, 5.0}) {
      meeting.relative_speed = speed;
      meeting.acceleration = acceleration;
      row(meetingRow(format("meeting at %.1f m/s, %.0f m/s^2", speed, acceleration), meeting,
                     meetings, settings.seed));
    }
  }
}

}  // namespace

BenchmarkSection identitySection() {
  return {"identity",
          "four LEDs in the paper's rig, 10 % missed detections, a false detection in every image, "
          "spots merge below 8 px, 10000 images per run.\n"
          "Identity swaps; LEDs with a new track id; LEDs in snapshots without a confirmed track "
          "within 0.1 m, and in the last snapshot; tracks in snapshots without an LED within 0.1 "
          "m; RMS error [mm]; late images.\n"
          "Then two LEDs whose spots merge in all views, 20 meetings per run: identity swaps of an "
          "oracle that knows motion model and spots, and later images, of this oracle with the "
          "tracker's filters, and of the tracker; LEDs with a new track id; left_out: never merged "
          "in all views, or not tracked; ratio: the tracker's swaps and new ids over the oracle's.",
          runIdentity};
}

}  // namespace wiimote_tracker
