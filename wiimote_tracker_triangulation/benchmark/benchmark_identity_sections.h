#ifndef WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_BENCHMARK_IDENTITY_SECTIONS_H
#define WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_BENCHMARK_IDENTITY_SECTIONS_H

#include "benchmark_tracking_sections.h"

namespace wiimote_tracker {

/// The paper's scheme after two periods; the period is not known.
BenchmarkSection paperSection();

/// The same with only some of the LEDs in view.
BenchmarkSection someInViewSection();

/// The same over the length of the period, down to what cameras cannot see any more.
BenchmarkSection periodsSection();

/// Cyclic codes after a while.
BenchmarkSection cyclicSection();

/// Blinking LEDs, still and moved, followed by the tracker.
BenchmarkSection movingSection();

/// What a sighting and a decision take.
BenchmarkSection timeSection();

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_BENCHMARK_IDENTITY_SECTIONS_H
