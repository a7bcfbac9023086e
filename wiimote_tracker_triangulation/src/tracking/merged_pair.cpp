#include "merged_pair.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::tracking {
namespace {

constexpr double kLeastLogLikelihood = -20.0;  // [log 1/px^2]; limits the weight of one bad spot
constexpr double kNegligible = 10.0;           // log of 22000 to 1

/// Images of a view are at most this far apart [s]. When no view showed two spots for longer, the
/// LEDs are merged in all views.
constexpr double kImageInterval = 0.02;

}  // namespace

MergedPair::MergedPair(std::uint32_t a, std::uint32_t b, const Filters& before)
    : ids_{a, b}, opened_at_(before[0].time()), last_separate_(opened_at_) {
  hypotheses_.push_back({before, 0.0});
}

std::optional<MergedPair::SpotIndices> MergedPair::update(const View& view, double gate) {
  if (view.pixels.size() < 2)
    return std::nullopt;
  Predictions predictions;
  for (std::size_t i = 0; i < hypotheses_.size(); ++i)
    predictions[i] = predict(view, gate, &hypotheses_[i]);
  const std::optional<SpotIndices> spots = likeliestSpots(predictions, view.pixels.size());
  if (!spots)
    return std::nullopt;
  if (!areSeparate(view.time))
    separated_at_ = view.time;
  has_separated_ = true;
  last_separate_ = view.time;
  return branch(predictions, view, *spots);
}

/// Predicts the hypothesis to the view's time and its spots in the view.
MergedPair::Prediction MergedPair::predict(const View& view,
                                           double gate,
                                           Hypothesis* hypothesis) const {
  Prediction result;
  for (std::size_t led = 0; led < 2; ++led) {
    motion::MotionFilter& filter = hypothesis->filters[led];
    filter.predict(view.time);
    const auto& predicted = result.pixels[led] = filter.predictPixel(*view.camera, view.noise);
    for (std::size_t spot = 0; spot < view.pixels.size(); ++spot) {
      const double likelihood = predicted ? predicted->logLikelihood(view.pixels[spot])
                                          : -std::numeric_limits<double>::infinity();
      result.log_likelihoods[led][spot] =
          likelihood > kLeastLogLikelihood ? likelihood : kLeastLogLikelihood;
      result.within_gate[led][spot] =
          predicted && predicted->squaredDistance(view.pixels[spot]) <= gate;
    }
  }
  return result;
}

/// The most likely two spots of all hypotheses, both within the gate.
std::optional<MergedPair::SpotIndices> MergedPair::likeliestSpots(const Predictions& predictions,
                                                                  std::size_t spot_count) const {
  std::optional<SpotIndices> result;
  double greatest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hypotheses_.size(); ++i) {
    const Prediction& prediction = predictions[i];
    for (std::size_t a = 0; a < spot_count; ++a) {
      for (std::size_t b = 0; b < spot_count; ++b) {
        if (a == b || !prediction.within_gate[0][a] || !prediction.within_gate[1][b])
          continue;
        const double sum = hypotheses_[i].log_likelihood + prediction.log_likelihoods[0][a] +
                           prediction.log_likelihoods[1][b];
        if (sum > greatest) {
          greatest = sum;
          result = {a, b};
        }
      }
    }
  }
  return result;
}

/// Each hypothesis becomes two, one for each assignment of the two spots; the likely ones are kept.
/// @returns the assignment of the most likely one
MergedPair::SpotIndices MergedPair::branch(const Predictions& predictions,
                                           const View& view,
                                           const SpotIndices& spots) {
  struct Branch {
    std::size_t parent;
    SpotIndices spots;
    double log_likelihood;
  };
  std::array<Branch, 2 * kMaximumHypotheses> branches{};
  std::size_t count = 0;
  for (std::size_t parent = 0; parent < hypotheses_.size(); ++parent) {
    const auto& likelihoods = predictions[parent].log_likelihoods;
    for (const SpotIndices& assigned : {spots, SpotIndices{spots[1], spots[0]}})
      branches[count++] = {parent, assigned,
                           hypotheses_[parent].log_likelihood + likelihoods[0][assigned[0]] +
                               likelihoods[1][assigned[1]]};
  }
  const std::size_t most = std::min(count, kMaximumHypotheses);
  std::partial_sort(
      branches.begin(), branches.begin() + most, branches.begin() + count,
      [](const Branch& a, const Branch& b) { return a.log_likelihood > b.log_likelihood; });
  const double greatest = branches[0].log_likelihood;
  const auto parents = hypotheses_;
  hypotheses_.clear();
  for (std::size_t i = 0; i < most; ++i) {
    const Branch& branch = branches[i];
    if (branch.log_likelihood < greatest - kNegligible)
      break;
    Hypothesis& hypothesis = hypotheses_.emplace_back(
        Hypothesis{parents[branch.parent].filters, branch.log_likelihood - greatest});
    for (std::size_t led = 0; led < 2; ++led) {
      if (const auto& predicted = predictions[branch.parent].pixels[led])
        hypothesis.filters[led].update(*view.camera, *predicted, view.pixels[branch.spots[led]]);
    }
  }
  return branches[0].spots;
}

double MergedPair::probability() const {
  double sum = 0.0;  // that of the most likely hypothesis is 1
  for (const Hypothesis& hypothesis : hypotheses_)
    sum += std::exp(hypothesis.log_likelihood);
  return 1.0 / sum;
}

bool MergedPair::areSeparate(double time) const {
  return has_separated_ && time - last_separate_ <= kImageInterval;
}

bool MergedPair::isDecided(double time, double doubt_time) const {
  if (!has_separated_)
    return false;
  // No view adds evidence while the spots are merged again: count from the last one that did.
  const bool is_timed_out = time - separated_at_ > doubt_time &&
                            (areSeparate(time) || time - last_separate_ > doubt_time);
  return hypotheses_.size() == 1 || is_timed_out;
}

}  // namespace wiimote_tracker::tracking
