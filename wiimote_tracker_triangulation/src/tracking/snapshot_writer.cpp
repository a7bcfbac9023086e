#include "snapshot_writer.h"

#include <algorithm>
#include <utility>

namespace wiimote_tracker::tracking {
namespace {

bool hasSmallerId(const TrackedLed& a, const TrackedLed& b) {
  return a.id < b.id;
}

}  // namespace

void SnapshotWriter::predict(const Groups& groups, double time, Snapshot* snapshot) const {
  snapshot->time = time;
  std::size_t count = 0;
  for (const auto& group : groups)
    count += group->tracks().size();
  snapshot->leds.resize(count);
  auto led = snapshot->leds.begin();
  for (const auto& group : groups) {
    for (const Track& track : group->tracks()) {
      track.report(time, options_, group->members(), &*led);
      if (led->state == TrackState::kTracked && group->isDoubtful())
        led->state = TrackState::kPredicted;
      ++led;
    }
  }
  std::sort(snapshot->leds.begin(), snapshot->leds.end(), hasSmallerId);
}

void SnapshotWriter::write(const Groups& groups, double time, Snapshot* snapshot) {
  predict(groups, time, snapshot);
  std::vector<TrackedLed>& leds = snapshot->leds;
  const auto count = static_cast<std::ptrdiff_t>(leds.size());
  for (const TrackedLed& led : before_) {
    if (std::binary_search(leds.begin(), leds.begin() + count, led, hasSmallerId))
      continue;
    TrackedLed& lost = leds.emplace_back(led);
    lost.state = TrackState::kLost;
    lost.cameras.clear();
    lost.rays_possible = 0;
    lost.residual = std::numeric_limits<double>::quiet_NaN();
  }
  before_.assign(leds.begin(), leds.begin() + count);
  std::sort(leds.begin(), leds.end(), hasSmallerId);
}

}  // namespace wiimote_tracker::tracking
