// What arrives from remotes that share one Bluetooth adapter, and how well exposure times are
// estimated from it.
#include "shared_radio.h"
#include "wiimote_tracker_driver/exposure_clock/exposure_clock.h"

#include <wiimote_tracker_msgs/benchmark_tables.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

using namespace wiimote_tracker;
using namespace wiimote_tracker::exposure_clock;

namespace {

constexpr double kSettling = 10.0;  // [s] Not judged: the clock learns the period.

double quantile(std::vector<double> values, double q) {
  const auto nth =
      values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size()));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

BenchmarkRow judge(const std::string& name, const RadioModel& model, double duration) {
  double rate = 1e9;  // of the remote that has the fewest images [1/s]
  std::vector<double> delays, errors, stddevs;
  double frames = 0.0;
  for (const auto& reports : simulateRadio(model, duration, 1)) {
    ExposureClock clock;
    std::size_t judged = 0;
    std::int64_t first_frame = 0;
    for (const virtual_wiimote::FrameTime& report : reports) {
      const Estimate estimate = clock.update(report.arrival);
      if (report.arrival < kSettling)
        continue;
      if (judged++ == 0)
        first_frame = report.frame;
      delays.push_back(report.arrival - report.exposure);
      errors.push_back(estimate.exposure - report.exposure);
      stddevs.push_back(estimate.stddev);
    }
    rate = std::min(rate, static_cast<double>(judged) / (duration - kSettling));
    if (!reports.empty())
      frames += static_cast<double>(reports.back().frame - first_frame + 1);
  }
  const auto count = static_cast<double>(errors.size());
  // The constant part of the delay. Wrong frame numbers, all of them too high, would move a mean.
  const double constant = quantile(errors, 0.5);
  double mean_delay = 0.0, squared = 0.0, covered = 0.0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double error = errors[i] - constant;
    mean_delay += delays[i] / count;
    squared += error * error / count;
    covered += (std::abs(error) < 2.0 * stddevs[i]) / count;
  }
  return {name,
          {{"images/s", rate},
           {"lost%", 100.0 * (1.0 - count / frames)},
           {"delay_ms", 1e3 * mean_delay},
           {"99%_ms", 1e3 * quantile(delays, 0.99)},
           {"error_ms", 1e3 * std::sqrt(squared)},
           {"in_2sd%", 100.0 * covered}}};
}

constexpr char kExplanation[] =
    "slots of basic rate: the adapter polls a remote in a slot of 0.625 ms, which answers in the "
    "next one; what is lost is sent again at the next poll. Polled at random, in turn, or in sniff "
    "mode, in which a remote listens once in 10 ms; share of packets lost. "
    "images/s: of the remote with the fewest; lost: share of all images; delay from the exposure, "
    "and that which 99 % stay below; error of the exposure times less its median (RMS), wrong "
    "frame numbers included; in_2sd: errors within two stddev. Without the first 10 s.";

void addRows(double duration, BenchmarkTables* tables) {
  using Polling = RadioModel::Polling;
  const std::vector<std::pair<Polling, const char*>> kPollings{
      {Polling::kAtRandom, "random"}, {Polling::kInTurn, "turn"}, {Polling::kSniff, "sniff"}};
  for (const auto& [polling, name] : kPollings) {
    for (const int remotes : {1, 4, 7}) {
      if (remotes > 1 && polling == Polling::kSniff)
        continue;  // each has its own time
      if (remotes == 1 && polling == Polling::kInTurn)
        continue;  // as at random
      for (const double loss : {0.0, 0.05, 0.15}) {
        RadioModel model;
        model.remotes = remotes;
        model.loss = loss;
        model.polling = polling;
        tables->add(judge(format("%d, %s, %g %%", remotes, name, 100.0 * loss), model, duration));
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  double duration = 130.0;
  BenchmarkTables tables;
  ArgumentParser parser("benchmark_radio",
                        "Rates, delays and exposure times of remotes at one Bluetooth adapter.");
  tables.addOptions(&parser);
  parser.option("--seconds S", &duration, 2.0 * kSettling, 1e5, "simulated time per row [s]");
  return parser.run(argc, argv, [&] {
    tables.begin("radio", kExplanation,
                 format("rosrun wiimote_tracker_driver benchmark_radio --seconds %g", duration));
    addRows(duration, &tables);
    tables.write();
    return 0;
  });
}
