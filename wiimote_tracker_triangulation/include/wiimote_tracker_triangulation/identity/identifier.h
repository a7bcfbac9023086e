#ifndef WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_IDENTIFIER_H
#define WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_IDENTIFIER_H

#include "wiimote_tracker_triangulation/identity/label_posterior.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace wiimote_tracker::identity {

struct IdentifierOptions {
  SeeingModel seeing;

  /// Probability that a light does not blink, before it was looked at [1e-9..0.5].
  double steady = 0.01;

  /// A label is given, or changed for another, when it is as probable as this [0.6..0.999999].
  double decide_at = 0.999;

  /// Sightings older than this fade out [s, 0.1..60]; with less than three of the longest periods,
  /// those are taken.
  double memory = 1.0;

  /// Shortest time between two decisions [s, 0..1].
  double interval = 0.02;

  /// @throws Error: out of range.
  void check() const;
};

/// Who an LED is thought to be.
struct Identity {
  std::optional<std::size_t> label;  ///< In BlinkCodes::codes; nothing: it has none, or not yet.
  bool steady = false;               ///< It does not blink, and so has no label.
  double confidence = 0.0;           ///< Probability of the label, at the last decision [0..1].
  double since = 0.0;                ///< When it was decided [s].
};

/// Gives the LEDs of a tracker their labels. An LED keeps its label until another one, or that it
/// does not blink at all, is as probable as a first decision needs. No two have the same label: the
/// first keeps it as long as that is likelier than not. The result is a function of the
/// options and of the sequence of calls; no clock is read. Does not allocate once warm.
class Identifier {
 public:
  /// @throws Error.
  Identifier(const BlinkCodes& codes, const IdentifierOptions& options);

  /// Of the LED with the tracker's id `led`, new or known. In any order of time, but each camera's
  /// in its own.
  void add(std::uint32_t led, const Sighting& sighting);

  /// The LED is gone for good. Its label is free for another one.
  void forget(std::uint32_t led);

  /// Decides, unless it is less than the interval since that was done. Call after add().
  /// @param time now [s], for Identity::since. When it has gone back, as with a bag that begins
  /// anew, the LEDs keep their labels and all evidence is forgotten.
  void decide(double time);

  /// Null: it had no sighting. Valid until the next call of another kind.
  const Identity* identityOf(std::uint32_t led) const;

  /// Forgets all LEDs.
  void reset();

  const BlinkCodes& codes() const { return hypotheses_.codes(); }

 private:
  struct Led {
    std::uint32_t id = 0;
    bool used = false;
    Evidence evidence;
    Identity identity;
    Eigen::VectorXd probabilities;  // of the labels, then that it does not blink

    double probabilityOf(std::size_t label) const {
      return probabilities(static_cast<Eigen::Index>(label));
    }
  };

  Led* find(std::uint32_t id);
  Led* place(std::uint32_t id);
  void judge(Led* led, double time);
  bool takeFromOthers(std::size_t label);

  IdentifierOptions options_;
  Hypotheses hypotheses_;
  LabelPosterior posterior_;
  std::vector<std::unique_ptr<Led>> leds_;  // places, used again
  std::vector<const Evidence*> evidence_;   // of those in use
  std::optional<double> origin_;            // of the phases [s]
  std::optional<double> decided_;           // when it was last done [s]
};

}  // namespace wiimote_tracker::identity

#endif  // WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_IDENTIFIER_H
