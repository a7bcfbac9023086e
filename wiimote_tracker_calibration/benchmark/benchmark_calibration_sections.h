#ifndef WIIMOTE_TRACKER_CALIBRATION_BENCHMARK_BENCHMARK_CALIBRATION_SECTIONS_H
#define WIIMOTE_TRACKER_CALIBRATION_BENCHMARK_BENCHMARK_CALIBRATION_SECTIONS_H

#include <wiimote_tracker_msgs/benchmark_tables.h>

#include <functional>
#include <string>

namespace wiimote_tracker {

/// A part of the benchmark, in a file of its own.
struct BenchmarkSection {
  std::string name;
  std::string explanation;  ///< Of the columns, for people.
  /// @param runs simulated sessions per row.
  std::function<void(int runs, const RowCallback& row)> run;
};

/// The wave and the wand: errors beside the Fisher bound, coverage, positions.
BenchmarkSection waveSection();

/// The wand on the floor beside the square.
BenchmarkSection floorSection();

/// How long the wave takes to solve.
BenchmarkSection waveTimeSection();

/// The pose of the square in one image: errors beside the Cramer-Rao bound, branches, time.
BenchmarkSection poseSection();

/// The same beside OpenCV's methods.
BenchmarkSection poseMethodsSection();

/// What following the verdict's advice to measure gains.
BenchmarkSection measureSection();

/// The paper's procedure, with its principal point correction.
BenchmarkSection paperSection();

/// Mistakes of a person, and what is said of them.
BenchmarkSection mistakesSection();

/// Corrections of a deformed volume.
BenchmarkSection remapSection();

/// Rooms that share no view, joined by an LED carried through the door.
BenchmarkSection roomsSection();

/// Eight hours with a rig that corrects itself.
BenchmarkSection continuousSection();

/// Other lights, and masked cameras, that must not change a rig.
BenchmarkSection misledSection();

/// A day without motion.
BenchmarkSection restSection();

/// Thirty days of tracker and health watch.
BenchmarkSection monthSection();

/// How soon it brings back a camera that was knocked.
BenchmarkSection knockSection();

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_BENCHMARK_BENCHMARK_CALIBRATION_SECTIONS_H
