// Accuracy of tracking LEDs, compared with bounds: one table per section.
#include "benchmark_program.h"

int main(int argc, char** argv) {
  using namespace wiimote_tracker;
  return runBenchmark(
      "benchmark_tracking",
      {filterSection(), hardSection(), unsynchronisedSection(), associationSection(),
       identitySection(), throughputSection(), scaleSection()},
      argc, argv, true);
}
