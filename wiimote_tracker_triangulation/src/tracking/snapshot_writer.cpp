#include "snapshot_writer.h"

#include <algorithm>
#include <utility>

namespace wiimote_tracker::tracking {
namespace {

bool hasSmallerId(const TrackedLed& a, const TrackedLed& b) {
  return a.id < b.id;
}

std::size_t countTracks(const SnapshotWriter::Groups& groups) {
  std::size_t count = 0;
  for (const auto& group : groups)
    count += group->tracks().size();
  return count;
}

}  // namespace

/// The snapshot has at least as many LEDs as there are tracks.
void SnapshotWriter::writeLeds(const Groups& groups, double time, Snapshot* snapshot) const {
  snapshot->time = time;
  auto led = snapshot->leds.begin();
  for (const auto& group : groups) {
    for (const Track& track : group->tracks()) {
      track.report(time, options_, group->members(), &*led);
      if (led->state == TrackState::kTracked && group->isDoubtful())
        led->state = TrackState::kPredicted;
      ++led;
    }
  }
  std::sort(snapshot->leds.begin(), led, hasSmallerId);
}

void SnapshotWriter::predict(const Groups& groups, double time, Snapshot* snapshot) {
  resize(countTracks(groups), &snapshot->leds);
  writeLeds(groups, time, snapshot);
}

void SnapshotWriter::write(const Groups& groups, double time, Snapshot* snapshot) {
  const std::size_t count = countTracks(groups);
  resize(count, &snapshot->leds);
  writeLeds(groups, time, snapshot);
  for (const TrackedLed& led : before_) {
    const auto end = snapshot->leds.begin() + static_cast<std::ptrdiff_t>(count);
    if (std::binary_search(snapshot->leds.begin(), end, led, hasSmallerId))
      continue;
    resize(snapshot->leds.size() + 1, &snapshot->leds);
    TrackedLed& lost = snapshot->leds.back();
    lost = led;
    lost.state = TrackState::kLost;
    lost.cameras.clear();
    lost.rays_possible = 0;
    lost.residual = std::numeric_limits<double>::quiet_NaN();
  }
  resize(count, &before_);
  std::copy_n(snapshot->leds.begin(), count, before_.begin());
  std::sort(snapshot->leds.begin(), snapshot->leds.end(), hasSmallerId);
}

void SnapshotWriter::resize(std::size_t count, std::vector<TrackedLed>* leds) {
  while (leds->size() > count) {
    spare_.push_back(std::move(leds->back().cameras));
    leds->pop_back();
  }
  while (leds->size() < count) {
    leds->emplace_back();
    if (spare_.empty())
      continue;
    leds->back().cameras = std::move(spare_.back());
    spare_.pop_back();
  }
}

}  // namespace wiimote_tracker::tracking
