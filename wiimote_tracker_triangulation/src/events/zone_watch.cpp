#include "events/zone_watch.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <optional>
#include <utility>

namespace wiimote_tracker::events {
namespace {

using geometry::Zone;

/// Part of a line segment that lies in a zone, as parameters on the segment [0..1].
struct Overlap {
  double begin = 0.0;
  double end = 1.0;
};

/// Clips the segment to the slabs between opposite sides (Kay and Kajiya 1986).
std::optional<Overlap> overlapOf(const Eigen::Vector3d& from,
                                 const Eigen::Vector3d& to,
                                 const Zone& zone) {
  Overlap overlap;
  for (int axis = 0; axis < 3; ++axis) {
    const double step = to[axis] - from[axis];
    double begin = zone.minimum[axis] - from[axis];
    double end = zone.maximum[axis] - from[axis];
    if (step == 0.0) {
      if (begin > 0.0 || end < 0.0)
        return std::nullopt;
      continue;
    }
    if (step < 0.0)
      std::swap(begin, end);
    overlap.begin = std::max(overlap.begin, begin / step);
    overlap.end = std::min(overlap.end, end / step);
  }
  if (overlap.begin > overlap.end)
    return std::nullopt;
  return overlap;
}

}  // namespace

void ZoneWatch::setZones(const std::vector<Zone>& zones) {
  const auto stays = [&](const Zone& zone) {
    return std::any_of(zones.begin(), zones.end(),
                       [&](const Zone& z) { return z.name == zone.name; });
  };
  for (Led& led : leds_) {
    for (const Zone& zone : zones_) {
      if (stays(zone))
        continue;
      if (led.presences[zone.name].inside)
        gone_.push_back({zone.name, led.id, false, 0.0, led.position});
      led.presences.erase(zone.name);
    }
  }
  zones_ = zones;
}

void ZoneWatch::loseAll() {
  for (const Led& led : leds_)
    lose(led, &gone_);
  leds_.clear();
}

const std::vector<ZoneCrossing>& ZoneWatch::update(const tracking::Snapshot& snapshot) {
  crossings_.swap(gone_);
  gone_.clear();
  for (ZoneCrossing& crossing : crossings_)
    crossing.time = snapshot.time;

  newest_ = snapshot.time;
  const auto isGone = [&](const Led& led) {
    return !(snapshot.time - led.time <= options_.timeout);
  };
  for (const Led& led : leds_) {
    if (isGone(led))
      lose(led, &crossings_);
  }
  leds_.erase(std::remove_if(leds_.begin(), leds_.end(), isGone), leds_.end());

  for (const tracking::TrackedLed& seen : snapshot.leds) {
    const auto place =
        std::lower_bound(leds_.begin(), leds_.end(), seen.id,
                         [](const Led& led, std::uint32_t id) { return led.id < id; });
    const bool known = place != leds_.end() && place->id == seen.id;
    switch (seen.state) {
      case tracking::TrackState::kTentative:
        break;
      case tracking::TrackState::kTracked:
      case tracking::TrackState::kPredicted:
        step(seen.position,
             known ? &*place : &*leds_.insert(place, {seen.id, newest_, seen.position, {}}));
        break;
      case tracking::TrackState::kLost:
        if (known) {
          lose(*place, &crossings_);
          leds_.erase(place);
        }
        break;
    }
  }
  return crossings_;
}

void ZoneWatch::step(const Eigen::Vector3d& to, Led* led) {
  const auto first = static_cast<std::ptrdiff_t>(crossings_.size());
  const Eigen::Vector3d from = led->position;
  const double began = led->time;
  const double duration = newest_ - began;
  for (const Zone& zone : zones_) {
    Presence& presence = led->presences[zone.name];
    const std::optional<Overlap> overlap = overlapOf(from, to, zone);
    if (overlap && !presence.inside) {
      presence.inside = true;
      crossings_.push_back({zone.name, led->id, true, began + overlap->begin * duration,
                            from + overlap->begin * (to - from)});
    }
    if (overlap) {
      presence.crossed = began + overlap->end * duration;
      presence.crossed_at = from + overlap->end * (to - from);
    }
    const Eigen::AlignedBox3d box(zone.minimum, zone.maximum);
    if (presence.inside && box.exteriorDistance(to) > options_.hysteresis) {
      presence.inside = false;
      crossings_.push_back({zone.name, led->id, false, presence.crossed, presence.crossed_at});
    }
  }
  led->position = to;
  led->time = newest_;
  std::stable_sort(crossings_.begin() + first, crossings_.end(),
                   [](const auto& a, const auto& b) { return a.time < b.time; });
}

void ZoneWatch::lose(const Led& led, std::vector<ZoneCrossing>* crossings) const {
  for (const Zone& zone : zones_) {
    const auto presence = led.presences.find(zone.name);
    if (presence != led.presences.end() && presence->second.inside)
      crossings->push_back({zone.name, led.id, false, newest_, led.position});
  }
}

}  // namespace wiimote_tracker::events
