#include "intrinsics/board_decoder.h"

#include "intrinsics/board_sequence.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace wiimote_tracker::intrinsics {

namespace {

constexpr double kPhaseStep = 0.005;       // between the phases tried [s]
constexpr int kSpotsPerFlash = 2;          // minimum: a flash gives about four, some are lost
constexpr double kLampShare = 0.25;        // above this share of the images: no LED (an LED: 0.04)
constexpr double kRadius = 4.0;            // spots this close are one light [px]
constexpr double kLeastSeparation = 12.0;  // between LEDs of a view [px]
constexpr double kMostMotion = 1.5;        // of an LED between its two flashes, RMS [px]
// Share of the spots, and of those of an LED, that follow the sequence.
constexpr double kLeastExplained = 0.8;
constexpr double kLongestGap = 0.1;  // between images [s]

/// Spots of one light that stayed in one place.
struct Light {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  std::vector<double> times;
  std::vector<Eigen::Vector2d> pixels;
  Eigen::Vector2d mean() const { return sum / static_cast<double>(times.size()); }
};

/// The spots of a light that fall into one step of the sequence.
struct Flash {
  int count = 0;
  double weight = 0.0;  // more for spots in the middle of the flash
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean() const { return sum / count; }
};

/// A light interpreted as an LED of the board.
struct Led {
  Flash row;
  Flash column;
  std::size_t spots = 0;  // of the light: one that moves slowly shines on after a flash
  bool seen() const {
    return row.count >= kSpotsPerFlash && column.count >= kSpotsPerFlash &&
           count() >= kLeastExplained * static_cast<double>(spots);
  }
  double weight() const { return seen() ? row.weight + column.weight : 0.0; }
  int count() const { return row.count + column.count; }
  Eigen::Vector2d mean() const { return (row.sum + column.sum) / count(); }
};
using Leds = std::array<Led, kBoardLeds>;

void addSpot(double time, const Eigen::Vector2d& pixel, std::vector<Light>* lights) {
  Light* nearest = nullptr;
  double distance = kRadius;
  for (Light& light : *lights) {
    const double d = (light.mean() - pixel).norm();
    if (d <= distance) {
      distance = d;
      nearest = &light;
    }
  }
  if (!nearest) {
    lights->emplace_back();
    nearest = &lights->back();
  }
  nearest->sum += pixel;
  nearest->times.push_back(time);
  nearest->pixels.push_back(pixel);
}

/// Steps since the start of the cycle, with fraction. The phase is the time at which step 0 starts
/// minus half the dark part of a step, so that a flash is in the middle of its step.
double stepsAt(double time, double phase) {
  const double in_cycle = std::fmod(time - phase, sequence::kCycle);
  const double steps = in_cycle / sequence::kStep + (in_cycle < 0.0 ? sequence::kSteps : 0.0);
  return steps < sequence::kSteps ? steps : 0.0;
}

/// Whether the board lights any LED in this step.
bool isLitStep(int step) {
  for (int i = 0; i < 4; ++i) {
    if (step == sequence::rowStep(i) || step == sequence::columnStep(i))
      return true;
  }
  return false;
}

/// The LED that a light is if the board has this phase; Led::seen() is false if it is none.
Led ledFromLight(const Light& light, double phase, int* number) {
  std::array<Flash, sequence::kSteps> flashes{};
  for (std::size_t i = 0; i < light.times.size(); ++i) {
    const double steps = stepsAt(light.times[i], phase);
    const int step = static_cast<int>(steps);
    const double off_middle = steps - step - 0.5;
    Flash& flash = flashes[static_cast<std::size_t>(step)];
    ++flash.count;
    flash.weight += 1.0 - 2.0 * off_middle * off_middle;
    flash.sum += light.pixels[i];
  }
  const auto flash = [&flashes](int step) { return flashes[static_cast<std::size_t>(step)]; };
  int row = 0;
  int column = 0;
  for (int i = 1; i < 4; ++i) {
    if (flash(sequence::rowStep(i)).weight > flash(sequence::rowStep(row)).weight)
      row = i;
    if (flash(sequence::columnStep(i)).weight > flash(sequence::columnStep(column)).weight)
      column = i;
  }
  *number = row * kBoardColumns + column;
  return {flash(sequence::rowStep(row)), flash(sequence::columnStep(column)), light.times.size()};
}

Leds ledsAtPhase(const std::vector<Light>& lights, double phase) {
  Leds leds{};
  for (const Light& light : lights) {
    int number = 0;
    const Led led = ledFromLight(light, phase, &number);
    Led& best = leds[static_cast<std::size_t>(number)];
    if (led.weight() > best.weight())
      best = led;
  }
  return leds;
}

double bestPhase(const std::vector<Light>& lights, double start) {
  double best = start;
  double best_weight = 0.0;
  for (double phase = start; phase < start + sequence::kCycle; phase += kPhaseStep) {
    double weight = 0.0;
    for (const Led& led : ledsAtPhase(lights, phase))
      weight += led.weight();
    if (weight > best_weight) {
      best_weight = weight;
      best = phase;
    }
  }
  return best;
}

double shareOfLeds(const std::vector<Light>& lights, const Leds& leds) {
  std::size_t spots = 0;
  for (const Light& light : lights)
    spots += light.times.size();
  int of_leds = 0;
  for (const Led& led : leds)
    of_leds += led.seen() ? led.count() : 0;
  return of_leds / static_cast<double>(spots);
}

/// Share of the spots that appear while the board lights LEDs. Used if there are lamps: each hides
/// one LED of a flash, so that an LED may be seen in one flash only.
double shareInLitSteps(const std::vector<Light>& lights, double phase) {
  std::size_t spots = 0;
  std::size_t explained = 0;
  for (const Light& light : lights) {
    spots += light.times.size();
    for (const double time : light.times)
      explained += isLitStep(static_cast<int>(stepsAt(time, phase))) ? 1 : 0;
  }
  return static_cast<double>(explained) / static_cast<double>(spots);
}

double motionBetweenFlashes(const Leds& leds) {
  double sum = 0.0;
  int count = 0;
  for (const Led& led : leds) {
    if (led.seen()) {
      sum += (led.row.mean() - led.column.mean()).squaredNorm();
      ++count;
    }
  }
  return count > 0 ? std::sqrt(sum / count) : 0.0;
}

BoardView viewOf(const Leds& leds) {
  BoardView view;
  for (std::size_t i = 0; i < leds.size(); ++i) {
    if (leds[i].seen())
      view.pixels[i] = leds[i].mean();
  }
  return view;
}

BoardReading refusal(const std::string& why) {
  return {std::nullopt, why};
}

double smallestSeparation(const BoardView& view) {
  double smallest = HUGE_VAL;
  for (std::size_t i = 0; i < view.pixels.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (view.pixels[i] && view.pixels[j])
        smallest = std::min(smallest, (*view.pixels[i] - *view.pixels[j]).norm());
    }
  }
  return smallest;
}

}  // namespace

void BoardDecoder::add(double time, const std::vector<Eigen::Vector2d>& spots) {
  if (!std::isfinite(time))
    return;
  if (!frames_.empty() && time < frames_.back().time - kLongestGap)
    frames_.clear();
  Frame frame{time, {}};
  for (const Eigen::Vector2d& spot : spots) {
    if (spot.allFinite())
      frame.spots.push_back(spot);
  }
  const auto later =
      std::upper_bound(frames_.begin(), frames_.end(), time,
                       [](double wanted, const Frame& other) { return wanted < other.time; });
  frames_.insert(later, std::move(frame));
  while (frames_.front().time <= frames_.back().time - sequence::kCycle)
    frames_.pop_front();
}

std::string BoardDecoder::whyNotReady() const {
  if (frames_.empty())
    return "no images: check the camera's connection and its driver";
  for (std::size_t i = 1; i < frames_.size(); ++i) {
    if (frames_[i].time - frames_[i - 1].time > kLongestGap)
      return format("no image came for %.0f ms: wait, and check the connection if this stays",
                    1e3 * (frames_[i].time - frames_[i - 1].time));
  }
  const double span = frames_.back().time - frames_.front().time;
  if (span < sequence::kCycle - kLongestGap)
    return format("%.1f of %.1f s: hold the board still", span, sequence::kCycle);
  return "";
}

BoardReading BoardDecoder::read() const {
  const std::string why_not_ready = whyNotReady();
  if (!why_not_ready.empty())
    return refusal(why_not_ready);

  std::vector<Light> lights;
  for (const Frame& frame : frames_) {
    for (const Eigen::Vector2d& spot : frame.spots)
      addSpot(frame.time, spot, &lights);
  }
  const double lamp = kLampShare * static_cast<double>(frames_.size());
  const auto lamps = std::remove_if(lights.begin(), lights.end(), [lamp](const Light& light) {
    return static_cast<double>(light.times.size()) > lamp;
  });
  const bool has_lamps = lamps != lights.end();
  lights.erase(lamps, lights.end());
  if (lights.empty())
    return refusal(has_lamps ? "only lights that do not blink: switch them off or cover them, and "
                               "switch the board on"
                             : "no light: switch the board on and bring it before the camera");

  const double phase = bestPhase(lights, frames_.front().time);
  const Leds leds = ledsAtPhase(lights, phase);
  const double explained = has_lamps ? shareInLitSteps(lights, phase) : shareOfLeds(lights, leds);
  if (explained < kLeastExplained)
    return refusal(
        format("%.0f %% of the spots follow the board's sequence, at least %.0f %% are needed: "
               "hold the board still and cover other lights",
               100.0 * explained, 100.0 * kLeastExplained));
  const double motion = motionBetweenFlashes(leds);
  if (motion > kMostMotion)
    return refusal(format("the board moved by %.1f px, at most %.1f px are allowed: hold it still",
                          motion, kMostMotion));
  const BoardView view = viewOf(leds);
  if (static_cast<int>(view.count()) < minimum_leds_)
    return refusal(
        format("%zu of %d LEDs stayed in place, at least %d are needed: hold the board still, "
               "and more of it in the image%s",
               view.count(), kBoardLeds, minimum_leds_, has_lamps ? "; cover other lights" : ""));
  const double separation = smallestSeparation(view);
  if (separation < kLeastSeparation)
    return refusal(
        format("LEDs are %.0f px from one another, at least %.0f px are needed: bring the board "
               "nearer or tilt it less",
               separation, kLeastSeparation));
  return {view, format("%zu of %d LEDs", view.count(), kBoardLeds)};
}

}  // namespace wiimote_tracker::intrinsics
