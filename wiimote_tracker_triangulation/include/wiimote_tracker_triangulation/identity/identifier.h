#pragma once

#include "wiimote_tracker_triangulation/identity/label_posterior.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace wiimote_tracker::identity {

/// The ranges are not checked here.
struct IdentifierOptions {
  /// Prior probability that a light does not blink [1e-9..0.5].
  double steady = 0.01;

  /// Probability at which a label is assigned or changed [0.6..0.999999].
  double decide_at = 0.999;

  /// Shortest time between two decisions [s, 0..1].
  double interval = 0.02;
};

/// The present decision about an LED.
struct Identity {
  std::optional<std::size_t> label;  ///< In BlinkCodes::codes; nothing: none, or not yet.
  bool steady = false;               ///< A light that does not blink.
  double confidence = 0.0;           ///< Probability of the label [0..1].
  double since = 0.0;                ///< Time of the decision [s].
};

/// Assigns labels to the LEDs of a tracker. An LED keeps its label until another label, or a light
/// that does not blink, reaches the probability of a first decision. Labels are unique: the first
/// LED keeps a label while its probability is at least 0.5. The result depends on the options and
/// the sequence of calls only. Does not allocate once warm.
class Identifier {
 public:
  /// @throws Error (see BlinkCodes::check).
  Identifier(const BlinkCodes& codes, const IdentifierOptions& options);

  /// Adds a sighting of the LED with the tracker's id `led`. Sightings of one camera must be in
  /// order of time.
  void add(std::uint32_t led, const Sighting& sighting);

  /// Removes an LED. Its label is free for another one.
  void forget(std::uint32_t led);

  /// Decides, unless less than the interval has passed since. Call after add().
  /// @param time now [s], for Identity::since; not before an earlier one, except after reset().
  void decide(double time);

  /// Null for an LED without sightings. Valid until the next call that is not const.
  const Identity* identityOf(std::uint32_t led) const;

  /// Forgets all LEDs, as when a bag starts over.
  void reset();

  const BlinkCodes& codes() const { return hypotheses_.codes(); }

 private:
  struct Led {
    std::uint32_t id = 0;
    bool used = false;
    Evidence evidence;
    Identity identity;
    Eigen::VectorXd probabilities;  // per label, then of not blinking

    double probabilityOf(std::size_t label) const {
      return probabilities(static_cast<Eigen::Index>(label));
    }
  };

  Led* find(std::uint32_t id) const;
  Led* place(std::uint32_t id);
  void judge(Led* led, double time);
  bool takeFromOthers(std::size_t label);

  IdentifierOptions options_;
  Hypotheses hypotheses_;
  LabelPosterior posterior_;
  std::vector<std::unique_ptr<Led>> leds_;  // reused
  std::vector<const Evidence*> evidence_;   // of the LEDs in use
  std::optional<double> origin_;            // of the phases [s]
  std::optional<double> decided_;           // last decision [s]
};

}  // namespace wiimote_tracker::identity
