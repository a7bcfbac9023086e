#include "wiimote_tracker_triangulation/identity/hypotheses.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::identity {
namespace {

// Phase error within the memory between neighbouring frequencies of the grid [periods].
constexpr double kPhasePerFrequency = 0.06;

// The phase of a sighting is rounded to 1/4 of the grid's step.
constexpr std::size_t kStepsPerPhase = 4;

// Exposure times are rounded to this [periods]; the last one stands for all longer ones.
constexpr double kBlurStep = 1.0 / 32.0;
constexpr std::size_t kBlurs = 13;

std::size_t phasesFor(const BlinkCodes& codes) {
  double shortest = 1.0;
  for (const BlinkCode& code : codes.codes)
    shortest = std::min(shortest, shortestRun(code.waveform));
  const double phases = std::clamp(std::ceil(4.0 / shortest), 32.0, 256.0);
  return 8 * static_cast<std::size_t>(std::ceil(phases / 8.0));  // whole SIMD vectors
}

std::vector<double> frequenciesOf(const BlinkCodes& codes, double memory) {
  const double lowest = 1.0 / codes.longest_period;
  const double highest = 1.0 / codes.shortest_period;
  const int steps = static_cast<int>(std::ceil((highest - lowest) * memory / kPhasePerFrequency));
  std::vector<double> frequencies;
  for (int i = 0; i <= steps; ++i)
    frequencies.push_back(lowest + (highest - lowest) * i / std::max(steps, 1));
  return frequencies;
}

const BlinkCodes& checked(const BlinkCodes& codes) {
  codes.check();
  return codes;
}

}  // namespace

Hypotheses::Hypotheses(const BlinkCodes& codes, double memory)
    : codes_(checked(codes)),
      memory_(std::max(memory, 3.0 * codes.longest_period)),
      phases_(phasesFor(codes)),
      frequencies_(frequenciesOf(codes, memory_)) {
  phase_blur_ = 1.0 / phases_;
  if (frequencies_.size() > 1)
    phase_blur_ += 0.5 * kPhasePerFrequency;
  log_likelihoods_.resize(kBlurs * 2 * kStepsPerPhase * labels() * 2 * phases_);
  for (std::size_t blur = 0; blur < kBlurs; ++blur) {
    for (const bool seen : {false, true}) {
      for (std::size_t step = 0; step < kStepsPerPhase; ++step) {
        for (std::size_t label = 0; label < labels(); ++label)
          fillRow(blur, seen, step, label);
      }
    }
  }
}

std::size_t Hypotheses::rowStart(std::size_t blur, bool seen, std::size_t step) const {
  return ((blur * 2 + (seen ? 1 : 0)) * kStepsPerPhase + step) * labels() * 2 * phases_;
}

void Hypotheses::fillRow(std::size_t blur, bool seen, std::size_t step, std::size_t label) {
  constexpr int kSamples = 16;  // over the blur of the phase
  const double phases = phases_;
  const double exposure = kBlurStep * blur;
  float* const row = &log_likelihoods_[rowStart(blur, seen, step) + label * 2 * phases_];
  for (std::size_t i = 0; i < 2 * phases_; ++i) {
    const double middle = (step + 0.5) / (kStepsPerPhase * phases) - i / phases;
    double light = 0.0;
    for (int k = 0; k < kSamples; ++k) {
      const double phase = middle + phase_blur_ * ((k + 0.5) / kSamples - 0.5);
      light += litShare(codes_.codes[label].waveform, phase - 0.5 * exposure, exposure) / kSamples;
    }
    const double probability = kSeenWhenOff + (kSeenWhenOn - kSeenWhenOff) * light;
    // Not seen: relative to an LED that is hidden, as Evidence::addLimited needs it.
    row[i] = static_cast<float>(seen ? std::log(probability)
                                     : std::log((1.0 - probability) / (1.0 - kSeenWhenOff)));
  }
}

const float* Hypotheses::rowsOf(const Sighting& sighting, double frequency, double periods) const {
  const double blurs = sighting.exposure * frequency / kBlurStep + 0.5;
  const auto blur = static_cast<std::size_t>(std::min(blurs, kBlurs - 1.0));
  const double phase = periods - std::floor(periods);
  const auto fine = std::min(static_cast<std::size_t>(phase * (kStepsPerPhase * phases_)),
                             kStepsPerPhase * phases_ - 1);
  const std::size_t step = fine % kStepsPerPhase;
  // A row holds two periods, so that a whole period is contiguous from any phase.
  const std::size_t first = phases_ - fine / kStepsPerPhase;
  return &log_likelihoods_[rowStart(blur, sighting.seen, step) + first];
}

double Hypotheses::steady(bool seen) const {
  return seen ? std::log(kSeenWhenOn) : std::log((1.0 - kSeenWhenOn) / (1.0 - kSeenWhenOff));
}

}  // namespace wiimote_tracker::identity
