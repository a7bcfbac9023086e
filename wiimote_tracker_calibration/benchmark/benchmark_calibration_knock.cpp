// Cameras that are turned while one LED, or a body, moves.
#include "benchmark_calibration_sections.h"
#include "knock_trial.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

namespace wiimote_tracker {

namespace {

constexpr double kKnockDegree = M_PI / 180.0;

/// The error only where two cameras were knocked.
BenchmarkRow rowOf(const std::string& name, const Knock& knock, int runs) {
  int found = 0;
  int others = 0;
  double sum = 0.0;
  double longest = 0.0;
  double squared = 0.0;
  for (int run = 0; run < runs; ++run) {
    const KnockTrial trial = runKnockTrial(knock, static_cast<std::uint64_t>(run));
    others += trial.others ? 1 : 0;
    if (!trial.found)
      continue;
    ++found;
    sum += trial.seconds;
    longest = std::max(longest, trial.seconds);
    squared += trial.error * trial.error;
  }
  const int any = std::max(1, found);
  BenchmarkRow row = {
      name, {{"found", found}, {"others", others}, {"mean_s", sum / any}, {"longest_s", longest}}};
  if (knock.knocked > 1)
    row.figures.emplace_back("mm", 1000.0 * std::sqrt(squared / any));
  return row;
}

std::string named(double degrees) {
  return "turned by " + std::to_string(degrees).substr(0, 3) + " degrees";
}

void runKnocks(int runs, const RowCallback& row) {
  for (const double degrees : {0.5, 1.0, 2.0, 3.0})
    row(rowOf(named(degrees), {degrees * kKnockDegree}, runs));
  for (const std::size_t leds : {2, 4}) {
    row(rowOf(named(2.0) + ", " + std::to_string(leds) + " LEDs of a body",
              {2.0 * kKnockDegree, 1, 0.0, false, 4, leds, true}, runs));
  }
}

void runTwoKnocks(int runs, const RowCallback& row) {
  for (const double degrees : {0.5, 1.0, 2.0, 3.0})
    row(rowOf(named(degrees), {degrees * kKnockDegree, 2}, runs));
  row(rowOf("turned by 2.0 degrees, 5 s apart", {2.0 * kKnockDegree, 2, 5.0}, runs));
  row(rowOf("two of five, by 2.0 degrees", {2.0 * kKnockDegree, 2, 0.0, false, 5}, runs));
  row(rowOf("on one shelf, by 1.0 degrees", {kKnockDegree, 2, 0.0, true}, runs));
  row(rowOf("two of five on one shelf, by 1.0 degrees", {kKnockDegree, 2, 0.0, true, 5}, runs));
}

}  // namespace

BenchmarkSection knockSection() {
  return {
      "knock",
      "a camera that is turned while one LED, or a body, moves: proposals for it and for others, "
      "time until then",
      runKnocks};
}

BenchmarkSection twoKnocksSection() {
  return {"two_knocks",
          "two cameras of four or five that are turned while one LED moves: runs in which both "
          "were found, in which another one was changed; time until then, RMS error of the volume "
          "then",
          runTwoKnocks};
}

}  // namespace wiimote_tracker
