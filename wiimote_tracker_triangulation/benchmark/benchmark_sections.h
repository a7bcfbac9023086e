#ifndef WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_BENCHMARK_SECTIONS_H
#define WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_BENCHMARK_SECTIONS_H

#include "benchmark_program.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

namespace wiimote_tracker {

/// Standard deviation of the simulated pixels, as the tracker is told [px].
constexpr double kPixelNoise = 0.3;

inline tracking::TrackerOptions trackerOptions() {
  tracking::TrackerOptions options;
  options.pixel_stddev = kPixelNoise;
  options.stamp_stddev = 0.0;
  return options;
}

// Of benchmark_tracking. What each measures is in its explanation.
BenchmarkSection associationSection();
BenchmarkSection filterSection();
BenchmarkSection hardSection();
BenchmarkSection unsynchronisedSection();
BenchmarkSection identitySection();
BenchmarkSection throughputSection();
BenchmarkSection scaleSection();

// Of benchmark_identity.
BenchmarkSection paperSection();
BenchmarkSection someInViewSection();
BenchmarkSection periodsSection();
BenchmarkSection cyclicSection();
BenchmarkSection movingSection();
BenchmarkSection timeSection();

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_BENCHMARK_SECTIONS_H
