#pragma once

#include "wiimote_tracker_triangulation/identity/evidence.h"

#include <Eigen/Core>

#include <vector>

namespace wiimote_tracker::identity {

/// Probabilities of the labels given the evidence: a column per LED, a row per label, and a last
/// row for a light that does not blink. Keeps its buffers between calls.
class LabelPosterior {
 public:
  /// @param steady prior probability that a light does not blink [1e-9..0.5].
  LabelPosterior(const Hypotheses& hypotheses, double steady);

  /// Asynchronous LEDs are independent. Synchronous LEDs share period and phase, and each label
  /// occurs at most once: exact sum over all assignments. The result for synchronous LEDs is the
  /// prior while too many periods and phases are possible, or when no assignment is, as where two
  /// LEDs have shown one code for long.
  /// @param leds evidence of the same hypotheses and, if synchronous, of the same origin.
  const Eigen::MatrixXd& compute(const std::vector<const Evidence*>& leds);

 private:
  void computeAlone(std::size_t led);
  void computeTogether(std::size_t leds);
  void setPrior();
  void weigh(std::size_t frequency, std::size_t phase, std::size_t leds);
  void addCell(std::size_t leds);
  double logWeightOfSteady(std::size_t led) const;

  const Hypotheses& hypotheses_;
  double steady_prior_;
  std::vector<LogLikelihoods> leds_;
  Eigen::MatrixXd posterior_;
  Eigen::ArrayXf best_, bound_;
  std::vector<double> reference_;           // per LED, logarithms
  std::vector<double> weights_;             // of one cell: [LED][label, then not blinking]
  std::vector<double> forward_, backward_;  // of one cell: [LED][set of labels]
};

}  // namespace wiimote_tracker::identity
