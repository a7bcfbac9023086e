#pragma once

#include "wiimote_tracker_triangulation/identity/blink_codes.h"

#include <cstddef>
#include <vector>

namespace wiimote_tracker::identity {

/// Whether one image shows one LED that it ought to show: inside the camera's view, not near
/// another spot with which it may merge, and not displaced by four brighter ones. Other images make
/// no sighting.
struct Sighting {
  std::size_t camera = 0;
  double time = 0.0;      ///< Middle of the exposure [s].
  double exposure = 0.0;  ///< Its length plus the uncertainty of its time [s, >= 0].
  bool seen = false;
};

constexpr double kSeenWhenOn = 0.94;   ///< Detection probability of an LED that is on.
constexpr double kSeenWhenOff = 0.01;  ///< Probability of a false detection.

/// Probability that a dark interval is an occlusion. It limits the evidence of one camera's dark
/// interval against an LED.
constexpr double kOccluded = 0.002;

/// Hypotheses about an LED: a grid of periods and phases for each label, with the likelihood of a
/// sighting under each. Shared by the evidence of all LEDs.
class Hypotheses {
 public:
  /// @param memory time constant of forgetting [s, > 0]; at least three of the longest periods.
  /// @throws Error (see BlinkCodes::check).
  explicit Hypotheses(const BlinkCodes& codes, double memory = 1.0);

  const BlinkCodes& codes() const { return codes_; }
  double memory() const { return memory_; }

  std::size_t labels() const { return codes_.codes.size(); }
  std::size_t phases() const { return phases_; }
  const std::vector<double>& frequencies() const { return frequencies_; }  ///< [Hz]

  /// Number of hypotheses. Those of a label at a frequency start at (frequency * labels() + label)
  /// * phases().
  std::size_t cells() const { return frequencies_.size() * labels() * phases_; }

  /// Log likelihoods of a sighting at one frequency; without a spot relative to those of a hidden
  /// LED. @returns rows of phases() values, one for each label, 2 * phases() values apart. Value i
  /// is for an LED whose waveform is at the phase `periods` - i / phases().
  /// @param frequency [Hz]. @param periods since the origin of the phases, any number.
  const float* rowsOf(const Sighting& sighting, double frequency, double periods) const;

  /// Log likelihood for a light that does not blink.
  double steady(bool seen) const;

 private:
  void fillRow(std::size_t blur, bool seen, std::size_t step, std::size_t label);
  std::size_t rowStart(std::size_t blur, bool seen, std::size_t step) const;

  BlinkCodes codes_;
  double memory_;
  std::size_t phases_;
  std::vector<double> frequencies_;
  double phase_blur_ = 0.0;             // by the grid's steps of phase and frequency [periods]
  std::vector<float> log_likelihoods_;  // [blur][seen][step within a phase][label][2 * phases]
};

}  // namespace wiimote_tracker::identity
