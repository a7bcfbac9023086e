#ifndef WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_BENCHMARK_TRACKING_SECTIONS_H
#define WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_BENCHMARK_TRACKING_SECTIONS_H

#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <wiimote_tracker_msgs/benchmark_tables.h>

#include <functional>
#include <string>

namespace wiimote_tracker {

struct BenchmarkSettings {
  int runs = 20;       ///< At least 1; each section says how much one run is.
  unsigned seed = 1;   ///< Of the random numbers.
  std::string motion;  ///< CSV file of recorded motion [mm]; empty: none.
};

/// A section of the benchmark; each has its own file.
struct BenchmarkSection {
  std::string name;
  std::string explanation;  ///< Of the columns.
  std::function<void(const BenchmarkSettings& settings, const RowCallback& row)> run;
};

/// Standard deviation of the simulated pixels, as the tracker is told [px].
constexpr double kPixelNoise = 0.3;

inline tracking::TrackerOptions trackerOptions() {
  tracking::TrackerOptions options;
  options.pixel_stddev = kPixelNoise;
  options.stamp_stddev = 0.0;
  return options;
}

BenchmarkSection associationSection();

/// The motion filter of one LED, compared with the bounds.
BenchmarkSection filterSection();

/// Random motion from slow to hard.
BenchmarkSection hardSection();

/// Unsynchronised cameras and uncertain stamps.
BenchmarkSection unsynchronisedSection();

/// The tracker over time: identity swaps, merged spots, lost tracks.
BenchmarkSection identitySection();

/// Frame sets per second on one core.
BenchmarkSection throughputSection();

/// Many rooms on one core.
BenchmarkSection scaleSection();

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_BENCHMARK_TRACKING_SECTIONS_H
