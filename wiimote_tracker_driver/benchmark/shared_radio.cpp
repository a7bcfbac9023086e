#include "shared_radio.h"

#include <cstddef>
#include <deque>
#include <random>

namespace wiimote_tracker::exposure_clock {
namespace {

constexpr double kSlot = 0.000625;  // [s]
constexpr double kLatency = 0.004;  // [s] From the exposure until the report is ready: assumed.

virtual_wiimote::FrameTimesModel camera(double phase) {
  virtual_wiimote::FrameTimesModel model;
  model.phase = phase;
  model.period_tolerance = 500e-6;
  return model;
}

/// One remote: its camera and the reports that wait to be polled.
struct Sender {
  Sender(double phase, std::uint64_t seed)
      : camera_times(camera(phase), seed), next(camera_times.next()) {}

  /// Takes the reports that are ready at `time` [s].
  void sampleUntil(double time, std::size_t places) {
    for (; next.exposure + kLatency <= time; next = camera_times.next()) {
      if (waiting.size() == places)
        waiting.pop_back();
      waiting.push_back(next);
    }
  }

  virtual_wiimote::FrameTimes camera_times;
  virtual_wiimote::FrameTime next;
  std::deque<virtual_wiimote::FrameTime> waiting;
};

/// The remote that is polled in the `turn`-th pair of slots; `remotes` or more: none. `chance`: a
/// random number from 0 to 1.
int polled(const RadioModel& model, std::int64_t turn, double chance) {
  if (model.polling == RadioModel::Polling::kAtRandom)
    return static_cast<int>(chance * model.remotes);
  const bool sniff = model.polling == RadioModel::Polling::kSniff;
  return static_cast<int>(turn % (sniff ? model.sniff_interval / 2 : model.remotes));
}

}  // namespace

std::vector<std::vector<virtual_wiimote::FrameTime>> simulateRadio(const RadioModel& model,
                                                                   double duration,
                                                                   std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::deque<Sender> senders;
  for (int i = 0; i < model.remotes; ++i)
    senders.emplace_back(0.01 * uniform(random), random());

  std::vector<std::vector<virtual_wiimote::FrameTime>> reports(senders.size());
  const auto turns = static_cast<std::int64_t>(duration / (2.0 * kSlot));
  for (std::int64_t turn = 0; turn < turns; ++turn) {
    const auto index = static_cast<std::size_t>(polled(model, turn, uniform(random)));
    if (index >= senders.size())
      continue;
    Sender& sender = senders[index];
    const double begin = 2.0 * kSlot * static_cast<double>(turn);
    sender.sampleUntil(begin + kSlot, static_cast<std::size_t>(model.queue));
    if (sender.waiting.empty() || uniform(random) < model.loss)
      continue;
    reports[index].push_back(sender.waiting.front());
    reports[index].back().arrival = begin + 2.0 * kSlot;
    sender.waiting.pop_front();
  }
  return reports;
}

}  // namespace wiimote_tracker::exposure_clock
