#pragma once

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

// What each measures is in its explanation.
BenchmarkSection waveSection();
BenchmarkSection floorSection();
BenchmarkSection measureSection();
BenchmarkSection paperSection();
BenchmarkSection remapSection();
BenchmarkSection roomsSection();
BenchmarkSection continuousSection();
BenchmarkSection knockSection();
BenchmarkSection twoKnocksSection();
BenchmarkSection misledSection();
BenchmarkSection restSection();
BenchmarkSection monthSection();

}  // namespace wiimote_tracker
