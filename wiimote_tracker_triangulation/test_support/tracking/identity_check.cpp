#include "tracking/identity_check.h"

#include <cmath>
#include <limits>

namespace wiimote_tracker::tracking::test {

std::vector<std::int64_t> idsAt(const Snapshot& snapshot,
                                const std::vector<Path>& leds,
                                double within) {
  std::vector<std::int64_t> ids;
  for (const Path& path : leds) {
    double least = within;
    ids.push_back(-1);
    for (const TrackedLed& led : snapshot.leds) {
      const double distance = (led.position - path(snapshot.time)).norm();
      if (led.state == TrackState::kTracked && distance < least) {
        least = distance;
        ids.back() = led.id;
      }
    }
  }
  return ids;
}

void IdentityCheck::add(const Snapshot& snapshot) {
  ++snapshots;
  for (const TrackedLed& track : snapshot.leds) {
    if (track.state == TrackState::kLost)
      led_of_id_.erase(track.id);
  }
  for (std::size_t led = 0; led < leds_.size(); ++led) {
    const Eigen::Vector3d truth = leds_[led](snapshot.time);
    const TrackedLed* nearest = nullptr;
    double least = kNear;
    for (const TrackedLed& track : snapshot.leds) {
      if (track.state != TrackState::kTracked && track.state != TrackState::kPredicted)
        continue;
      // The LED's previous track is preferred, so that two LEDs that pass each other do not look
      // exchanged.
      const auto owner = led_of_id_.find(track.id);
      const bool was_its = owner != led_of_id_.end() && owner->second == led;
      const double distance = (track.position - truth).norm();
      if (distance < kNear && (was_its || distance < least)) {
        least = was_its ? 0.0 : distance;
        nearest = &track;
      }
    }
    if (!nearest) {
      ++uncovered;
      continue;
    }
    const auto id = static_cast<std::int64_t>(nearest->id);
    const auto owner = led_of_id_.find(nearest->id);
    if (owner == led_of_id_.end()) {
      renamed += last_ids_[led] >= 0 && last_ids_[led] != id;
      led_of_id_[nearest->id] = led;
    } else if (owner->second != led) {
      // Near two LEDs: an exchange only when it is no longer near its own.
      if ((leds_[owner->second](snapshot.time) - nearest->position).norm() < kNear)
        continue;
      ++switches;
      owner->second = led;
    }
    last_ids_[led] = id;
    squared_error += (nearest->position - truth).squaredNorm();
    ++near;
  }
  for (const TrackedLed& track : snapshot.leds) {
    if (track.state != TrackState::kTracked)
      continue;
    double least = std::numeric_limits<double>::infinity();
    for (const Path& led : leds_)
      least = std::min(least, (led(snapshot.time) - track.position).norm());
    false_tracks += least >= kNear;
  }
}

double IdentityCheck::rms() const {
  return std::sqrt(squared_error / static_cast<double>(near));
}

}  // namespace wiimote_tracker::tracking::test
