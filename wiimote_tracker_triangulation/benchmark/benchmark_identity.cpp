// How often blinking LEDs get a wrong label: one table per section.
#include "benchmark_sections.h"

int main(int argc, char** argv) {
  using namespace wiimote_tracker;
  return runBenchmark("benchmark_identity",
                      {paperSection(), periodsSection(), cyclicSection(), movingSection()}, argc,
                      argv);
}
