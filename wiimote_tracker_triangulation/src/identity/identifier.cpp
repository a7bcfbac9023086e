#include "wiimote_tracker_triangulation/identity/identifier.h"

namespace wiimote_tracker::identity {

Identifier::Identifier(const BlinkCodes& codes, const IdentifierOptions& options)
    : options_(options), hypotheses_(codes), posterior_(hypotheses_, options.steady) {}

Identifier::Led* Identifier::find(std::uint32_t id) const {
  for (const auto& led : leds_) {
    if (led->used && led->id == id)
      return led.get();
  }
  return nullptr;
}

Identifier::Led* Identifier::place(std::uint32_t id) {
  Led* free = nullptr;
  for (const auto& led : leds_) {
    if (!led->used)
      free = led.get();
  }
  if (!free) {
    leds_.push_back(std::make_unique<Led>(Led{id, true, Evidence(hypotheses_), {}, {}}));
    free = leds_.back().get();
    evidence_.reserve(leds_.size());
  }
  free->id = id;
  free->used = true;
  free->identity = {};
  free->probabilities.setZero(hypotheses_.labels() + 1);
  free->evidence.reset(*origin_);
  return free;
}

void Identifier::add(std::uint32_t id, const Sighting& sighting) {
  if (!origin_)
    origin_ = sighting.time;
  Led* led = find(id);
  if (!led)
    led = place(id);
  led->evidence.add(sighting);
}

void Identifier::forget(std::uint32_t id) {
  if (Led* led = find(id))
    led->used = false;
}

void Identifier::reset() {
  for (const auto& led : leds_)
    led->used = false;
  origin_.reset();
  decided_.reset();
}

void Identifier::decide(double time) {
  if (decided_ && time < *decided_ + options_.interval)
    return;
  decided_ = time;
  evidence_.clear();
  for (const auto& led : leds_) {
    if (led->used)
      evidence_.push_back(&led->evidence);
  }
  if (evidence_.empty())
    return;
  const Eigen::MatrixXd& probabilities = posterior_.compute(evidence_);
  Eigen::Index column = 0;
  for (const auto& led : leds_) {
    if (led->used)
      led->probabilities = probabilities.col(column++);
  }
  for (const auto& led : leds_) {
    if (led->used)
      judge(led.get(), time);
  }
  for (const auto& led : leds_) {
    Identity& identity = led->identity;
    identity.confidence = identity.label ? led->probabilityOf(*identity.label) : 0.0;
  }
}

void Identifier::judge(Led* led, double time) {
  Eigen::Index best = 0;
  if (!(led->probabilities.maxCoeff(&best) >= options_.decide_at))
    return;
  const std::size_t label = best;
  if (label == hypotheses_.labels()) {
    if (!led->identity.steady)
      led->identity = {std::nullopt, true, 0.0, time};
  } else if (led->identity.label != label && takeFromOthers(label)) {
    led->identity = {label, false, 0.0, time};
  }
}

bool Identifier::takeFromOthers(std::size_t label) {
  for (const auto& led : leds_) {
    if (!led->used || led->identity.label != label)
      continue;
    // The LED with this label keeps it while it is likely; the other is its mirror image.
    if (led->probabilityOf(label) >= 0.5)
      return false;
    led->identity = {};
  }
  return true;
}

const Identity* Identifier::identityOf(std::uint32_t id) const {
  const Led* led = find(id);
  return led ? &led->identity : nullptr;
}

}  // namespace wiimote_tracker::identity
