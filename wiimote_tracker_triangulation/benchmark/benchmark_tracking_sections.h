#ifndef WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_BENCHMARK_TRACKING_SECTIONS_H
#define WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_BENCHMARK_TRACKING_SECTIONS_H

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker {

/// One line of a section's table: what was simulated, and the figures, by their column's name.
struct BenchmarkRow {
  std::string name;
  std::vector<std::pair<std::string, double>> figures;
};

/// Takes a row as soon as it is known. Rows with other columns than the one before begin a new
/// table.
using RowCallback = std::function<void(const BenchmarkRow&)>;

/// How much to simulate, and of what.
struct BenchmarkSettings {
  int runs = 20;       ///< How much: at least 1; each section says of what.
  unsigned seed = 1;   ///< Of everything random.
  std::string motion;  ///< CSV file of recorded motion [mm]; empty: none.
};

/// A part of the benchmark, in a file of its own.
struct BenchmarkSection {
  std::string name;
  std::string explanation;  ///< Of the columns, for people.
  std::function<void(const BenchmarkSettings& settings, const RowCallback& row)> run;
};

BenchmarkSection associationSection();

/// One LED's motion filter, beside the bounds.
BenchmarkSection filterSection();

/// Cameras on clocks of their own, uncertain stamps.
BenchmarkSection unsynchronisedSection();

/// The tracker over time: identities, encounters, lost tracks.
BenchmarkSection identitySection();

/// Frame sets per second on one core.
BenchmarkSection throughputSection();

/// Many rooms on one core.
BenchmarkSection scaleSection();

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_BENCHMARK_TRACKING_SECTIONS_H
