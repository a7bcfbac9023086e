#ifndef WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_BENCHMARK_PROGRAM_H
#define WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_BENCHMARK_PROGRAM_H

#include "benchmark_tracking_sections.h"

#include <string>
#include <vector>

namespace wiimote_tracker {

/// A benchmark's main(): runs all sections, or the requested one, prints their tables and writes
/// them as JSON. @param takes_motion whether it has the option --motion.
int runBenchmark(const std::string& program,
                 const std::vector<BenchmarkSection>& sections,
                 int argc,
                 char** argv,
                 bool takes_motion = false);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BENCHMARK_BENCHMARK_PROGRAM_H
