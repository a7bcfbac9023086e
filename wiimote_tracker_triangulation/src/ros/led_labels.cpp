#include "led_labels.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace wiimote_tracker {

using identity::Identity;

namespace {

constexpr double kPlaceMemory = 10.0;  // [s]

}  // namespace

void LedLabels::update(double time,
                       const std::vector<tracking::TrackedLed>& leds,
                       const identity::Identifier* identifier) {
  forgetOldPlaces(time);
  for (const std::uint32_t id : forgotten_)
    given_.erase(id);
  forgotten_.swap(lost_);
  lost_.clear();
  for (const tracking::TrackedLed& led : leds) {
    if (led.state == tracking::TrackState::kLost) {
      lost_.push_back(led.id);
      continue;
    }
    if (identifier)
      takeIdentity(led.id, *identifier);
    const Identity* identity = identifier ? identifier->identityOf(led.id) : nullptr;
    const bool may_be_listed = !identifier || (identity && identity->steady);
    if (may_be_listed && led.state == tracking::TrackState::kTracked && given_.count(led.id) == 0)
      giveFreeLabel(led);
    const auto given = given_.find(led.id);
    if (given != given_.end() && !given->second.isIdentified())
      places_[given->second.name] = {led.position, time};
  }
}

void LedLabels::forgetOldPlaces(double time) {
  for (auto place = places_.begin(); place != places_.end();) {
    if (!place->second.time)
      place->second.time = time;
    place = time - *place->second.time > kPlaceMemory ? places_.erase(place) : std::next(place);
  }
}

void LedLabels::takeIdentity(std::uint32_t id, const identity::Identifier& identifier) {
  const Identity* identity = identifier.identityOf(id);
  const auto given = given_.find(id);
  if (identity && identity->label)
    given_[id] = {identifier.codes().codes[*identity->label].label, identity->confidence,
                  identity->since};
  else if (given != given_.end() && given->second.isIdentified())
    given_.erase(given);
}

void LedLabels::giveFreeLabel(const tracking::TrackedLed& led) {
  const std::string* best = nullptr;
  double least = 0.0;
  for (const std::string& label : listed_) {
    if (isTaken(label))
      continue;
    const auto place = places_.find(label);
    const double distance = place != places_.end() ? (place->second.position - led.position).norm()
                                                   : std::numeric_limits<double>::infinity();
    if (!best || distance < least) {
      best = &label;
      least = distance;
    }
  }
  if (best)
    given_[led.id].name = *best;
}

bool LedLabels::isTaken(const std::string& label) const {
  return std::any_of(given_.begin(), given_.end(), [&](const auto& given) {
    return given.second.name == label &&
           std::find(forgotten_.begin(), forgotten_.end(), given.first) == forgotten_.end();
  });
}

LedLabel LedLabels::of(std::uint32_t id) const {
  const auto given = given_.find(id);
  if (given != given_.end())
    return given->second;
  LedLabel label;
  label.name = unlisted(id);
  return label;
}

void LedLabels::clear() {
  lost_.clear();
  for (const auto& given : given_)
    lost_.push_back(given.first);
  setFormerPlaces(places_);
}

void LedLabels::setFormerPlaces(const Places& places) {
  places_ = places;
  for (auto& place : places_)
    place.second.time.reset();
}

}  // namespace wiimote_tracker
