#ifndef WIIMOTE_TRACKER_DRIVER_BENCHMARK_RESULTS_H
#define WIIMOTE_TRACKER_DRIVER_BENCHMARK_RESULTS_H

#include <string>
#include <vector>

namespace wiimote_tracker {

/// A number with its unit and its name.
struct Result {
  std::string name;  ///< Lower case with underscores.
  double value;
  std::string unit;
};

using Results = std::vector<Result>;

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_DRIVER_BENCHMARK_RESULTS_H
