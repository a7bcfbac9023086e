#include "led_labels.h"

#include <algorithm>

namespace wiimote_tracker {

void LedLabels::update(const std::vector<tracking::TrackedLed>& leds) {
  for (const std::uint32_t id : forgotten_)
    given_.erase(id);
  forgotten_.swap(lost_);
  lost_.clear();
  for (const tracking::TrackedLed& led : leds) {
    if (led.state == tracking::TrackState::kTracked && given_.count(led.id) == 0)
      giveFreeLabel(led.id);
    if (led.state == tracking::TrackState::kLost)
      lost_.push_back(led.id);
  }
}

void LedLabels::giveFreeLabel(std::uint32_t id) {
  const auto label = std::find_if(listed_.begin(), listed_.end(),
                                  [&](const std::string& l) { return !isTaken(l); });
  if (label != listed_.end())
    given_[id] = *label;
}

bool LedLabels::isTaken(const std::string& label) const {
  return std::any_of(given_.begin(), given_.end(), [&](const auto& given) {
    return given.second == label &&
           std::find(forgotten_.begin(), forgotten_.end(), given.first) == forgotten_.end();
  });
}

std::string LedLabels::of(std::uint32_t id) const {
  const auto given = given_.find(id);
  return given != given_.end() ? given->second : unlisted(id);
}

void LedLabels::clear() {
  lost_.clear();
  for (const auto& given : given_)
    lost_.push_back(given.first);
}

}  // namespace wiimote_tracker
