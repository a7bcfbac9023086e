// Accuracy of tracking LEDs, compared with bounds: one table per section.
#include "benchmark_sections.h"

int main(int argc, char** argv) {
  using namespace wiimote_tracker;
  return runBenchmark(
      "benchmark_tracking",
      {filterSection(), hardSection(), unsynchronisedSection(), associationSection(),
       identitySection(), throughputSection(), scaleSection()},
      argc, argv, [](ArgumentParser* parser, BenchmarkSettings* settings) {
        parser->option("--motion FILE.csv", &settings->motion,
                       "recorded motion [mm] for the section filter");
      });
}
