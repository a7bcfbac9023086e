#include "identity/led_labels.h"

#include "identity/led_name.h"

#include <wiimote_tracker_msgs/doubtful_label.h>
#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace wiimote_tracker::identity {
namespace {

constexpr double kPlaceMemory = 10.0;  // later an LED may be anywhere [s]
constexpr double kNear = 0.1;          // error of a place after no time [m]
constexpr double kLeastSpeed = 0.3;    // of an LED out of sight, per axis [m/s]
constexpr double kSameCourse = 2.0;    // for how long it goes on as before [s]
constexpr double kAnywhere = 0.003;    // density of an LED that was carried off [1/m^3]

/// Speed of the fastest LED when it was seen last [m/s]. It is used for all LEDs, since one that
/// paused when it was seen last may have moved on.
double greatestSpeed(const LedLabels::Places& places) {
  double greatest = 0.0;
  for (const auto& [label, place] : places)
    greatest = std::max(greatest, place.speed);
  return greatest;
}

/// Of an LED that moved since it was seen at a place [1/m^3]. The variance grows with the square of
/// the age at first, and in proportion to it later, as that of a random walk.
double densityAt(const Eigen::Vector3d& position, const LedLabels::Place& place, double speed) {
  const double age = std::max(0.0, place.age);
  if (age > kPlaceMemory)
    return kAnywhere;
  const double way = (kLeastSpeed + speed / std::sqrt(3.0)) * age;
  const double variance = kNear * kNear + way * way / (1.0 + age / kSameCourse);
  return kAnywhere + std::exp(-0.5 * (position - place.position).squaredNorm() / variance) /
                         std::pow(2.0 * M_PI * variance, 1.5);
}

/// Not if it was seen beside that LED.
bool mayBeThatOf(const LedLabels::Place& place, std::uint32_t id) {
  return std::find(place.tracked_with.begin(), place.tracked_with.end(), id) ==
         place.tracked_with.end();
}

}  // namespace

void LedLabels::update(double time,
                       const std::vector<tracking::TrackedLed>& leds,
                       const Identifier* identifier) {
  agePlaces(time);
  is_updated_ = true;
  doubtful_.clear();
  for (const std::uint32_t id : forgotten_)
    given_.erase(id);
  forgotten_.swap(lost_);
  lost_.clear();
  tracked_.clear();
  for (const tracking::TrackedLed& led : leds) {
    if (led.state == tracking::TrackState::kTracked)
      tracked_.push_back(led.id);
  }
  for (const tracking::TrackedLed& led : leds) {
    if (led.state == tracking::TrackState::kLost) {
      lost_.push_back(led.id);
      continue;
    }
    giveLabel(time, led, identifier);
    if (led.state == tracking::TrackState::kTracked)
      notePlace(led);
  }
}

void LedLabels::forgetLamps(const std::function<bool(const Eigen::Vector3d&)>& is_hidden) {
  for (auto place = places_.begin(); place != places_.end();) {
    const auto former = former_.find(place->first);
    if (!is_hidden(place->second.position) || hasTrack(place->first)) {
      ++place;
    } else if (former != former_.end() && !is_hidden(former->second.position)) {
      place->second = former->second;
      ++place;
    } else {
      place = places_.erase(place);
    }
  }
}

/// Stamps that jump back, as those of images that waited, lower the ages: what is repeated counts
/// once. Not by more than the memory, for clocks that are set back.
void LedLabels::agePlaces(double time) {
  const double passed = newest_ ? time - *newest_ : 0.0;
  newest_ = time;
  for (Places* places : {&places_, &former_}) {
    for (auto& place : *places)
      place.second.age = std::max(-kPlaceMemory, place.second.age + passed);
  }
}

/// That of its code or, if it does not blink and is tracked, one of the list.
void LedLabels::giveLabel(double time,
                          const tracking::TrackedLed& led,
                          const Identifier* identifier) {
  if (identifier)
    takeIdentity(led.id, *identifier);
  const Identity* identity = identifier ? identifier->identityOf(led.id) : nullptr;
  const bool may_be_listed = !identifier || (identity && identity->steady);
  if (may_be_listed && led.state == tracking::TrackState::kTracked && given_.count(led.id) == 0)
    giveFreeLabel(time, led);
}

void LedLabels::takeIdentity(std::uint32_t id, const Identifier& identifier) {
  const Identity* identity = identifier.identityOf(id);
  const auto given = given_.find(id);
  if (identity && identity->label)
    given_[id] = {identifier.codes().codes[*identity->label].label, identity->confidence,
                  identity->since, true, 1.0};
  else if (given != given_.end() && given->second.identified)
    given_.erase(given);
}

/// Compares the LED with the places where labels were seen last. It may be the LED of a free label;
/// that of a label which another LED got again, perhaps wrongly; or, while a label of the list was
/// never given, a new one.
LedLabels::Choice LedLabels::choiceFor(const tracking::TrackedLed& led) const {
  const double speed = greatestSpeed(places_);
  Choice choice;
  bool may_be_new = false;
  for (const std::string& label : listed_) {
    if (const LedLabel* holder = holderOf(label)) {
      const auto former = former_.find(label);
      if (former != former_.end() && holder->confidence < 1.0)
        choice.add((1.0 - holder->confidence) * densityAt(led.position, former->second, speed));
      continue;
    }
    const auto place = places_.find(label);
    may_be_new = may_be_new || place == places_.end();
    const double density = place != places_.end() && mayBeThatOf(place->second, led.id)
                               ? densityAt(led.position, place->second, speed)
                               : 0.0;
    choice.add(density);
    if (!choice.label || density > choice.density) {
      choice.label = &label;
      choice.density = density;
    }
  }
  if (may_be_new)
    choice.add(kAnywhere);
  return choice;
}

/// Gives the free label that fits best, with a confidence if it was given before.
void LedLabels::giveFreeLabel(double time, const tracking::TrackedLed& led) {
  const Choice choice = choiceFor(led);
  if (!choice.label)
    return;
  LedLabel& given = given_[led.id];
  given.name = *choice.label;
  given.same_led_probability = led.same_led_probability;
  const auto place = places_.find(given.name);
  if (place == places_.end())
    return;
  given.since = time;
  former_[given.name] = place->second;
  // Of an LED that may be anywhere an old doubt tells nothing.
  const double right_there = place->second.age > kPlaceMemory ? 1.0 : place->second.confidence;
  setConfidence(choice.confidence(right_there), choice.probability(), &given);
}

/// Where an LED with a label of the list is, and whether it met another one.
void LedLabels::notePlace(const tracking::TrackedLed& led) {
  const auto given = given_.find(led.id);
  if (given == given_.end() || given->second.identified)
    return;
  LedLabel& label = given->second;
  const auto [found, is_new] = places_.try_emplace(label.name);
  Place& place = found->second;
  if (is_new && std::isfinite(label.confidence))
    place.confidence = label.confidence;
  place.position = led.position;
  place.speed = led.velocity ? led.velocity->norm() : 0.0;
  place.age = 0.0;
  place.tracked_with = tracked_;
  if (std::isnan(label.same_led_probability))
    label.same_led_probability = led.same_led_probability;
  if (!(led.same_led_probability < label.same_led_probability))
    return;
  former_[label.name] = place;
  const double same = led.same_led_probability / label.same_led_probability;
  setConfidence(place.confidence * same, same, &label);
  label.same_led_probability = led.same_led_probability;
}

/// @param same probability that this time the label stayed with its LED. Where that is doubtful, a
/// label that was doubtful already is named again: somebody may have found it right.
void LedLabels::setConfidence(double confidence, double same, LedLabel* given) {
  Place& place = places_.at(given->name);
  if (confidence < kDoubtfulLabel && (place.confidence >= kDoubtfulLabel || same < kDoubtfulLabel))
    doubtful_.push_back(given->name);
  place.confidence = confidence;
  given->confidence = confidence;
}

std::vector<std::string> LedLabels::doubtfulNow() const {
  std::vector<std::string> labels;
  for (const auto& [label, place] : places_) {
    if (place.confidence < kDoubtfulLabel && hasTrack(label))
      labels.push_back(label);
  }
  return labels;
}

std::string LedLabels::correct(const std::string& label, const std::string& right) {
  const auto led = std::find_if(tracked_.begin(), tracked_.end(),
                                [&](std::uint32_t id) { return of(id).name == label; });
  if (led == tracked_.end())
    return "no LED is tracked as '" + label + "' now: bring it in view, and see what it is called";
  if (of(*led).identified)
    return "'" + label + "' has its label by its blink code: change its code";
  if (std::find(listed_.begin(), listed_.end(), right) == listed_.end())
    return "'" + right + "' is no label of LEDs that do not blink: " +
           (listed_.empty() ? "list it in labels" : "choose from " + joined(listed_));
  const bool is_listed = given_.count(*led) > 0;
  if (label != right)
    exchange(label, right, is_listed);
  former_.erase(right);
  LedLabel& given = given_[*led];
  if (!is_listed)
    given.same_led_probability = std::numeric_limits<double>::quiet_NaN();  // see notePlace()
  given.name = right;
  given.confidence = 1.0;
  given.since = *newest_;
  const auto place = places_.find(right);
  if (place != places_.end())
    place->second.confidence = 1.0;
  return "";
}

/// Gives other LEDs that have the label `right` the label `label`, and each label the other's
/// place. Where `label` is not of the list, the others lose theirs, and both places are forgotten.
void LedLabels::exchange(const std::string& label, const std::string& right, bool is_listed) {
  for (auto other = given_.begin(); other != given_.end();) {
    const bool has_it = other->second.name == right;
    if (has_it)
      other->second.name = label;
    other = has_it && !is_listed ? given_.erase(other) : std::next(other);
  }
  const auto move = [&](Places::node_type place, const std::string& to) {
    if (!place || !is_listed)
      return;
    place.key() = to;
    places_.insert(std::move(place));
  };
  auto others = places_.extract(right);
  move(places_.extract(label), right);
  move(std::move(others), label);
  former_.erase(label);
}

bool LedLabels::hasTrack(const std::string& label) const {
  return std::any_of(given_.begin(), given_.end(), [&](const auto& given) {
    const auto is_in = [&](const std::vector<std::uint32_t>& ids) {
      return std::find(ids.begin(), ids.end(), given.first) != ids.end();
    };
    return given.second.name == label && !is_in(lost_) && !is_in(forgotten_);
  });
}

const LedLabel* LedLabels::holderOf(const std::string& label) const {
  for (const auto& [id, given] : given_) {
    if (given.name == label &&
        std::find(forgotten_.begin(), forgotten_.end(), id) == forgotten_.end())
      return &given;
  }
  return nullptr;
}

LedLabel LedLabels::of(std::uint32_t id) const {
  const auto given = given_.find(id);
  if (given != given_.end())
    return given->second;
  LedLabel label;
  label.name = numberedName(id);
  return label;
}

const LedLabels::Places* LedLabels::placesToKeep() {
  return std::exchange(is_updated_, false) && !places_.empty() ? &places_ : nullptr;
}

void LedLabels::clear() {
  lost_.clear();
  for (const auto& given : given_)
    lost_.push_back(given.first);
}

}  // namespace wiimote_tracker::identity
