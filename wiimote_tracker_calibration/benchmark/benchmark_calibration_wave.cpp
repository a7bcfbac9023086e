#include "benchmark_calibration_sections.h"
#include "rms.h"
#include "wave_trial.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace wiimote_tracker {

namespace {

using namespace wave;

double percent(const Share& share) {
  return share.all > 0 ? 100.0 * share.inside / share.all
                       : std::numeric_limits<double>::quiet_NaN();
}

BenchmarkRow rowOf(const std::string& name, const WaveScene& scene, int runs) {
  std::vector<WaveTrial> trials;
  std::vector<double> offsets, offset_bounds, offset_stddevs;
  double worst_length = 0.0;
  Share intervals, regions;
  const auto append = [](const std::vector<double>& from, std::vector<double>* to) {
    to->insert(to->end(), from.begin(), from.end());
  };
  for (int seed = 1; seed <= runs; ++seed) {
    const WaveTrial trial = runWaveTrial(scene, static_cast<std::uint64_t>(seed), true);
    if (!trial.refusal.empty())
      continue;
    trials.push_back(trial);
    append(trial.offset_errors, &offsets);
    append(trial.offset_bounds, &offset_bounds);
    append(trial.offset_stddevs, &offset_stddevs);
    worst_length = std::max(worst_length, std::abs(trial.length_error));
    intervals.inside += trial.intervals.inside;
    intervals.all += trial.intervals.all;
    regions.inside += trial.regions.inside;
    regions.all += trial.regions.all;
  }
  const auto magnitude = [](double x) { return std::abs(x); };
  double worst_offset = 0.0;
  for (const double offset : offsets)
    worst_offset = std::max(worst_offset, std::abs(offset));
  const double rigid = rms(trials, [](auto& t) { return t.error.rigid; });
  const double similarity = rms(trials, [](auto& t) { return t.error.similarity; });
  const double solved = rms(trials, [](auto& t) { return t.position.solved; });
  return {name,
          {{"absolute", 1e3 * rms(trials, [](auto& t) { return t.error.absolute; })},
           {"rigid", 1e3 * rigid},
           {"rigid/bd", rigid / rms(trials, [](auto& t) { return t.bound.rigid; })},
           {"similar", 1e3 * similarity},
           {"similar/bd", similarity / rms(trials, [](auto& t) { return t.bound.similarity; })},
           {"offset", 1e3 * rms(offsets, magnitude)},
           {"offset/bd", rms(offsets, magnitude) / rms(offset_bounds, magnitude)},
           {"stated", 1e3 * rms(offset_stddevs, magnitude)},
           {"worst", 1e3 * worst_offset},
           {"params %", percent(intervals)},
           {"points %", percent(regions)},
           {"length %", 100.0 * worst_length},
           {"position", 1e3 * solved},
           {"/perfect", solved / rms(trials, [](auto& t) { return t.position.perfect; })},
           {"square/", rms(trials, [](auto& t) { return t.position.square; }) / solved},
           {"refused", static_cast<double>(runs) - static_cast<double>(trials.size())}}};
}

void runWave(int runs, const RowCallback& row) {
  for (const std::size_t cameras : {4, 2}) {
    const std::string name = std::to_string(cameras) + " cameras, ";
    for (const double pixel : {0.3, 0.5}) {
      WaveScene scene;
      scene.camera_count = cameras;
      scene.pixel = pixel;
      row(rowOf(name + format("square + wave, %.1f px", pixel), scene, runs));
    }
    WaveScene scene;
    scene.camera_count = cameras;
    scene.wander = 0.0003;
    row(rowOf(name + "square + wave, stamps 0.3 ms", scene, runs));
    scene.wander = 0.0;
    scene.length = 0.5;
    for (const double pixel : {0.3, 0.5}) {
      scene.pixel = pixel;
      row(rowOf(name + format("square + wand, %.1f px", pixel), scene, runs));
    }
    scene.pixel = 0.3;
    scene.side = 1.5;
    row(rowOf(name + "square of 1.5 m + wand, 0.3 px", scene, runs));
    scene.side = 2.5;
    scene.wander = 0.0003;
    row(rowOf(name + "square + wand, stamps 0.3 ms", scene, runs));
    scene.wander = 0.0;
    scene.square = false;
    row(rowOf(name + "wand alone, 0.3 px", scene, runs));
  }
}

void runFloor(int runs, const RowCallback& row) {
  for (const std::size_t cameras : {4, 2}) {
    const std::string name = std::to_string(cameras) + " cameras, ";
    WaveScene scene;
    scene.camera_count = cameras;
    scene.pixel = 0.3;
    scene.length = 0.5;
    row(rowOf(name + "square + wand", scene, runs));
    scene.square = false;
    scene.rest = 2.5;
    row(rowOf(name + "wand on the floor", scene, runs));
  }
}

}  // namespace

BenchmarkSection waveSection() {
  return {
      "wave",
      "the paper's rig and cube; lenses off by 4 % and 20 px, k1 by 0.02, corners by 5 mm, clocks "
      "by up to 10 ms; 15 s at 1.3 m/s, whole pixels, 5 % of the spots wrong. RMS error of the "
      "volume's points [mm]: absolute, after a rigid motion, after a similarity, and over the "
      "Cramer-Rao bound (bd); time offsets [ms]: RMS, over the bound, as stated, worst; 95 % "
      "intervals of parameters and ellipsoids of points that hold the truth [%]; worst mean error "
      "of the wand's length [%]; RMS of single measurements, aligned on 500 others [mm]: solved, "
      "over perfect cameras, the square alone over solved; refused sessions.",
      runWave};
}

BenchmarkSection floorSection() {
  return {
      "floor",
      "a wand that lies on the floor before it is waved, beside the square: as the section wave, "
      "0.3 px before rounding; accelerometers off by 3 degrees (RMS about each axis), the wand's "
      "ends by 5 mm in height.",
      runFloor};
}

}  // namespace wiimote_tracker
