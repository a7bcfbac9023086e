#ifndef WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_HYPOTHESES_H
#define WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_HYPOTHESES_H

#include "wiimote_tracker_triangulation/identity/blink_codes.h"
#include "wiimote_tracker_triangulation/identity/sighting.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace wiimote_tracker::identity {

/// All that an LED may be doing: a grid of periods and of phases for each label, and how likely
/// each of them makes a sighting. Shared by the evidence of all LEDs.
class Hypotheses {
 public:
  /// @param memory sightings older than this fade out [s, > 0]; with less than three of the longest
  /// periods, those are taken. @throws Error (see BlinkCodes::check).
  Hypotheses(const BlinkCodes& codes, const SeeingModel& seeing, double memory);

  const BlinkCodes& codes() const { return codes_; }
  const SeeingModel& seeing() const { return seeing_; }
  double memory() const { return memory_; }

  std::size_t labels() const { return codes_.codes.size(); }
  std::size_t phases() const { return phases_; }
  const std::vector<double>& frequencies() const { return frequencies_; }  ///< [Hz]

  /// Of one label at one frequency begins at (frequency * labels() + label) * phases().
  std::size_t cells() const { return frequencies_.size() * labels() * phases_; }

  /// Where a sighting finds its likelihoods at one frequency.
  struct Lookup {
    const float* row;    ///< Of the first label, for phases 0, 1, ...
    std::size_t stride;  ///< From one label's row to the next.
  };

  /// Log likelihoods of a sighting, relative to those of a hidden LED, that has gone through
  /// `periods` periods (any number) of a frequency [Hz] since phase 0. The LED's phase is that of
  /// its waveform at the time of periods = 0, counted backwards.
  Lookup lookup(const Sighting& sighting, double frequency, double periods) const;

  /// The same for a light that does not blink.
  double steady(bool seen) const;

 private:
  void fillRow(std::size_t blur, bool seen, std::size_t step, std::size_t label);
  std::size_t rowStart(std::size_t blur, bool seen, std::size_t step) const;

  BlinkCodes codes_;
  SeeingModel seeing_;
  double memory_;
  std::size_t phases_;
  std::vector<double> frequencies_;
  double doubt_ = 0.0;           // of the phase, from grid and frequency [periods]
  std::vector<float> likeness_;  // [blur][seen][step within a phase][label][2 * phases]
};

}  // namespace wiimote_tracker::identity

#endif  // WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_HYPOTHESES_H
