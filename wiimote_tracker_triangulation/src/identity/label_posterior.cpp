#include "wiimote_tracker_triangulation/identity/label_posterior.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::identity {
namespace {

// Cells less likely than the best by a factor of e^-16 are neglected.
constexpr float kNegligible = 16.0f;

// With more possible periods and phases than this, the prior is returned.
constexpr Eigen::Index kMostCells = 2000;

}  // namespace

LabelPosterior::LabelPosterior(const Hypotheses& hypotheses, double steady)
    : hypotheses_(hypotheses), steady_prior_(steady) {}

double LabelPosterior::logWeightOfSteady(std::size_t led) const {
  return leds_[led].steady + std::log(steady_prior_ / (1.0 - steady_prior_) * hypotheses_.labels());
}

const Eigen::MatrixXd& LabelPosterior::compute(const std::vector<const Evidence*>& leds) {
  leds_.resize(std::max(leds_.size(), leds.size()));
  posterior_.setZero(hypotheses_.labels() + 1, leds.size());
  for (std::size_t led = 0; led < leds.size(); ++led)
    leds[led]->read(&leds_[led]);
  if (hypotheses_.codes().synchronous && leds.size() > 1) {
    computeTogether(leds.size());
  } else {
    for (std::size_t led = 0; led < leds.size(); ++led)
      computeAlone(led);
  }
  return posterior_;
}

void LabelPosterior::computeAlone(std::size_t led) {
  const Eigen::Index phases = hypotheses_.phases();
  const std::size_t labels = hypotheses_.labels();
  const std::size_t frequencies = hypotheses_.frequencies().size();
  const double steady = logWeightOfSteady(led);
  const double reference = std::max(steady, static_cast<double>(leds_[led].cells.maxCoeff()));
  auto column = posterior_.col(led);
  for (std::size_t i = 0; i < frequencies * labels; ++i) {
    const auto cells = leds_[led].cells.segment(i * phases, phases);
    if (cells.maxCoeff() < reference - kNegligible)
      continue;
    column(i % labels) += static_cast<double>((cells - static_cast<float>(reference)).exp().sum());
  }
  column /= frequencies * hypotheses_.phases();
  column(labels) = std::exp(steady - reference);
  column /= column.sum();
}

void LabelPosterior::computeTogether(std::size_t leds) {
  const Eigen::Index phases = hypotheses_.phases();
  const Eigen::Index labels = hypotheses_.labels();
  const Eigen::Index frequencies = hypotheses_.frequencies().size();
  // Upper bound of an assignment: every LED takes its best label.
  bound_.setZero(frequencies * phases);
  for (std::size_t led = 0; led < leds; ++led) {
    const auto steady = static_cast<float>(logWeightOfSteady(led));
    for (Eigen::Index f = 0; f < frequencies; ++f) {
      best_.setConstant(phases, steady);
      for (Eigen::Index label = 0; label < labels; ++label)
        best_ = best_.max(leds_[led].cells.segment((f * labels + label) * phases, phases));
      bound_.segment(f * phases, phases) += best_;
    }
  }
  Eigen::Index likeliest = 0;
  const float best = bound_.maxCoeff(&likeliest);
  if ((bound_ > best - kNegligible).count() > kMostCells) {
    setPrior();
    return;
  }
  // Each LED's weights are divided by a reference to avoid overflow and underflow.
  reference_.resize(leds);
  for (std::size_t led = 0; led < leds; ++led) {
    reference_[led] = logWeightOfSteady(led);
    for (Eigen::Index label = 0; label < labels; ++label)
      reference_[led] =
          std::max(reference_[led],
                   static_cast<double>(leds_[led].cells(
                       (likeliest / phases * labels + label) * phases + likeliest % phases)));
  }
  for (Eigen::Index cell = 0; cell < bound_.size(); ++cell) {
    if (!(bound_(cell) > best - kNegligible))
      continue;
    weigh(cell / phases, cell % phases, leds);
    addCell(leds);
  }
  // Each column has the same sum, that of all assignments, which underflows if none is possible.
  if (!(posterior_.colwise().sum().minCoeff() > 0.0)) {
    setPrior();
    return;
  }
  for (Eigen::Index led = 0; led < posterior_.cols(); ++led)
    posterior_.col(led) /= posterior_.col(led).sum();
}

void LabelPosterior::setPrior() {
  const Eigen::Index labels = hypotheses_.labels();
  posterior_.setConstant((1.0 - steady_prior_) / labels);
  posterior_.row(labels).setConstant(steady_prior_);
}

/// Sets weights_ for one period and phase.
void LabelPosterior::weigh(std::size_t frequency, std::size_t phase, std::size_t leds) {
  const std::size_t labels = hypotheses_.labels();
  weights_.clear();
  for (std::size_t led = 0; led < leds; ++led) {
    for (std::size_t label = 0; label < labels; ++label)
      weights_.push_back(
          std::exp(leds_[led].cells((frequency * labels + label) * hypotheses_.phases() + phase) -
                   reference_[led]));
    weights_.push_back(std::exp(logWeightOfSteady(led) - reference_[led]));
  }
}

/// Adds all assignments of distinct labels, or none, to the LEDs; their sum is a permanent. With
/// the weights w, over the sets S of labels that the LEDs before one have taken:
///   forward(led + 1, S + label) += forward(led, S) w(led, label),
///   backward(led, S) = sum over labels of w(led, label) backward(led + 1, S + label),
///   P(label of led) ~ sum over S of forward(led, S) w(led, label) backward(led + 1, S + label).
/// Without a label, S stays.
void LabelPosterior::addCell(std::size_t leds) {
  const std::size_t labels = hypotheses_.labels();
  const std::size_t sets = std::size_t{1} << labels;
  forward_.assign((leds + 1) * sets, 0.0);
  backward_.assign((leds + 1) * sets, 0.0);
  forward_[0] = 1.0;
  std::fill(backward_.end() - sets, backward_.end(), 1.0);
  for (std::size_t led = 0; led < leds; ++led) {
    const double* weight = &weights_[led * (labels + 1)];
    const double* from = &forward_[led * sets];
    double* to = &forward_[(led + 1) * sets];
    for (std::size_t taken = 0; taken < sets; ++taken) {
      to[taken] += from[taken] * weight[labels];
      for (std::size_t label = 0; label < labels; ++label) {
        if (!(taken >> label & 1))
          to[taken | std::size_t{1} << label] += from[taken] * weight[label];
      }
    }
  }
  for (std::size_t led = leds; led-- > 0;) {
    const double* weight = &weights_[led * (labels + 1)];
    const double* from = &backward_[(led + 1) * sets];
    double* to = &backward_[led * sets];
    const double* before = &forward_[led * sets];
    for (std::size_t taken = 0; taken < sets; ++taken) {
      to[taken] = from[taken] * weight[labels];
      posterior_(labels, led) += before[taken] * to[taken];
      for (std::size_t label = 0; label < labels; ++label) {
        if (taken >> label & 1)
          continue;
        const double rest = weight[label] * from[taken | std::size_t{1} << label];
        to[taken] += rest;
        posterior_(label, led) += before[taken] * rest;
      }
    }
  }
}

}  // namespace wiimote_tracker::identity
