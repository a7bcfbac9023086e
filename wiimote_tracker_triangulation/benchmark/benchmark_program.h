#pragma once

#include <wiimote_tracker_msgs/benchmark_tables.h>

#include <functional>
#include <string>
#include <vector>

namespace wiimote_tracker {

struct BenchmarkSettings {
  int runs = 20;       ///< At least 1; each section says how much one run is.
  unsigned seed = 1;   ///< Of the random numbers.
  std::string motion;  ///< CSV file of recorded motion [mm]; empty: none.
};

/// A section of a benchmark, in a file of its own.
struct BenchmarkSection {
  std::string name;
  std::string explanation;  ///< Of the columns.
  std::function<void(const BenchmarkSettings& settings, const RowCallback& row)> run;
};

/// Processor time of this program [s]: other programs do not count.
double processorTime();

/// A benchmark's main(): runs all sections, or the requested one, prints their tables and writes
/// them as JSON. @param add_options of this benchmark only.
int runBenchmark(const std::string& program,
                 const std::vector<BenchmarkSection>& sections,
                 int argc,
                 char** argv,
                 const std::function<void(ArgumentParser*, BenchmarkSettings*)>& add_options = {});

}  // namespace wiimote_tracker
