#ifndef WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_LABEL_POSTERIOR_H
#define WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_LABEL_POSTERIOR_H

#include "wiimote_tracker_triangulation/identity/evidence.h"

#include <Eigen/Core>

#include <vector>

namespace wiimote_tracker::identity {

/// Probability of each label for each LED, from the LEDs' evidence; a column per LED, a row per
/// label, and a last row for a light that does not blink. Keeps its memory from call to call.
class LabelPosterior {
 public:
  /// @param steady probability that a light does not blink, before it was looked at [1e-9..0.5].
  LabelPosterior(const Hypotheses& hypotheses, double steady);

  /// Each LED for itself, or, where they blink together, all of them: one period and phase, every
  /// label at most once, summed over all ways exactly. Together, as long as nearly every period and
  /// phase is possible, the probabilities are those from before anything was seen.
  /// @param leds all of the same hypotheses; together, their evidence has one origin.
  const Eigen::MatrixXd& compute(const std::vector<const Evidence*>& leds);

 private:
  void computeAlone(std::size_t led);
  void computeTogether(std::size_t leds);
  void addCell(std::size_t frequency, std::size_t phase, std::size_t leds);
  double logWeightOfSteady(std::size_t led) const;

  const Hypotheses& hypotheses_;
  double steady_prior_;
  std::vector<Eigen::ArrayXf> cells_;  // of each LED
  std::vector<double> steady_;         // likewise
  Eigen::MatrixXd posterior_;
  Eigen::ArrayXf best_, bound_;
  std::vector<double> reference_, weights_, forward_, backward_;
};

}  // namespace wiimote_tracker::identity

#endif  // WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_LABEL_POSTERIOR_H
