#ifndef WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_BENCHMARK_IDENTITY_SECTIONS_H
#define WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_BENCHMARK_IDENTITY_SECTIONS_H

#include "benchmark_tracking_sections.h"

namespace wiimote_tracker {

/// The paper's scheme after two periods; the period is not known.
BenchmarkSection paperSection();

/// The same with only some of the LEDs in view.
BenchmarkSection someInViewSection();

/// The same for shorter periods, down to ones that cameras cannot resolve.
BenchmarkSection periodsSection();

/// Cyclic codes by the time observed.
BenchmarkSection cyclicSection();

/// Blinking LEDs at rest and moving, followed by the tracker.
BenchmarkSection movingSection();

/// Processing time of a sighting and of a decision.
BenchmarkSection timeSection();

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_BENCHMARK_IDENTITY_SECTIONS_H
