#pragma once

#include "benchmark_program.h"

namespace wiimote_tracker {

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
BenchmarkSection periodsSection();
BenchmarkSection cyclicSection();
BenchmarkSection movingSection();

}  // namespace wiimote_tracker
