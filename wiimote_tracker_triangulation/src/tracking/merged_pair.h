#pragma once

#include "association/assign_spots.h"
#include "motion/motion_filter.h"
#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <Eigen/Core>
#include <boost/container/static_vector.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace wiimote_tracker::tracking {

/// Two LEDs whose spots merged, until it is decided which is which.
///
/// A merged spot does not measure the relative position of the two, so both filters keep their
/// former motion. When a view shows two spots again, either LED may belong to either spot,
/// independently in each view. Each assignment of the spots so far is a hypothesis with two
/// filters; all hypotheses of sufficient likelihood are kept.
class MergedPair {
 public:
  using Filters = std::array<motion::MotionFilter, 2>;

  /// One image, with the spots that may be of the two.
  struct View {
    const geometry::Camera* camera;
    geometry::PixelNoise noise;
    double time;  // [s]
    boost::container::static_vector<Eigen::Vector2d, association::kMaximumSpots> pixels;
  };
  using SpotIndices = std::array<std::size_t, 2>;  // each LED's spot in a View

  /// @param before their filters before the spots merged.
  MergedPair(std::uint32_t a, std::uint32_t b, const Filters& before);

  const std::array<std::uint32_t, 2>& ids() const { return ids_; }
  bool has(std::uint32_t id) const { return ids_[0] == id || ids_[1] == id; }
  double openedAt() const { return opened_at_; }  // [s]

  /// Updates the hypotheses with two spots of the view. Views must come in the order of their
  /// times.
  /// @param gate squared Mahalanobis distance [1]
  /// @returns the spots of the most likely hypothesis. Nothing, and nothing is updated, when no
  /// hypothesis has both LEDs' spots within the gate.
  std::optional<SpotIndices> update(const View& view, double gate);

  /// The filters of the most likely hypothesis, at the last view that updated them.
  const Filters& likeliest() const { return hypotheses_.front().filters; }

  /// Probability of the most likely hypothesis among those that are left [0..1].
  double probability() const;

  /// Whether some view showed two spots just before a time [s].
  bool areSeparate(double time) const;

  /// Whether the most likely hypothesis is accepted at a time [s].
  /// @param doubt_time see TrackerOptions [s]
  bool isDecided(double time, double doubt_time) const;

 private:
  struct Hypothesis {
    Filters filters;
    double log_likelihood;  // relative to the most likely hypothesis
  };

  /// Predictions of one hypothesis for a view; first index: the LED.
  struct Prediction {
    std::array<std::optional<motion::PixelPrediction>, 2> pixels;
    std::array<std::array<double, association::kMaximumSpots>, 2> log_likelihoods;
    std::array<std::array<bool, association::kMaximumSpots>, 2> within_gate;
  };
  static constexpr std::size_t kMaximumHypotheses = 4;
  using Predictions = std::array<Prediction, kMaximumHypotheses>;

  Prediction predict(const View& view, double gate, Hypothesis* hypothesis) const;
  std::optional<SpotIndices> likeliestSpots(const Predictions& predictions,
                                            std::size_t spot_count) const;
  SpotIndices branch(const Predictions& predictions, const View& view, const SpotIndices& spots);

  std::array<std::uint32_t, 2> ids_;
  double opened_at_;            // [s]
  double last_separate_;        // last view with two spots [s]; opened_at_ before the first
  bool has_separated_ = false;  // there was such a view
  double separated_at_ = 0.0;   // when the spots last separated [s]
  boost::container::static_vector<Hypothesis, kMaximumHypotheses> hypotheses_;  // likeliest first
};

}  // namespace wiimote_tracker::tracking
