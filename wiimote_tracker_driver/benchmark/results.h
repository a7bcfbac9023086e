#ifndef WIIMOTE_TRACKER_DRIVER_BENCHMARK_RESULTS_H
#define WIIMOTE_TRACKER_DRIVER_BENCHMARK_RESULTS_H

#include <wiimote_tracker_msgs/text.h>

#include <cstdio>
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

inline void print(const std::string& title, const Results& results) {
  std::printf("%s\n", title.c_str());
  for (const Result& result : results)
    std::printf("  %-36s %14.6g %s\n", result.name.c_str(), result.value, result.unit.c_str());
  std::printf("\n");
  std::fflush(stdout);
}

/// {"name": {"value": 1, "unit": "ms"}, ...}
inline std::string json(const Results& results) {
  std::string text = "{";
  for (const Result& result : results) {
    const std::string number = format("%.9g", result.value);
    text += (text.size() > 1 ? ", " : "") + ("\"" + result.name) + "\": {\"value\": " + number +
            ", \"unit\": \"" + result.unit + "\"}";
  }
  return text + "}";
}

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_DRIVER_BENCHMARK_RESULTS_H
