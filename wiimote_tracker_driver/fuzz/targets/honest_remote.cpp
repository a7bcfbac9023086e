#include "honest_remote.h"

#include <algorithm>

namespace wiimote_tracker::fuzz {

using protocol::Report;
using virtual_wiimote::Bytes;

HonestRemote::HonestRemote() {
  virtual_wiimote::Light light;
  light.x = 300.0;
  light.y = 400.0;
  senses.lights.assign(1, light);
}

void HonestRemote::hear(const Report& output, double now) {
  for (const Bytes& answer : device.handleOutput(Bytes(output.begin(), output.end())))
    say(answer, now + kAnswerDelay);
}

void HonestRemote::say(const Bytes& bytes, double due) {
  if (spoken.size() < kQueue)
    spoken.push_back({due, bytes});
}

std::optional<Report> HonestRemote::next(double& now, double until) {
  for (;;) {
    const bool sample_first = spoken.empty() || next_sample < spoken.front().due;
    const double due = sample_first ? next_sample : spoken.front().due;
    if (due > until) {
      now = std::max(now, until);
      return std::nullopt;
    }
    now = std::max(now, due);
    if (sample_first) {
      // After a pause only the newest image is left.
      next_sample = std::max(next_sample + kPeriod, now);
      if (const auto sampled = device.sample(senses))
        say(*sampled, now);
      continue;
    }
    const Report report(spoken.front().bytes.data(), spoken.front().bytes.size());
    spoken.pop_front();
    return report;
  }
}

}  // namespace wiimote_tracker::fuzz
