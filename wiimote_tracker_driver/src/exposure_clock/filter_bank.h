#pragma once

#include "exposure_clock/clock_filter.h"
#include "exposure_clock/frame_counter.h"
#include "exposure_clock/stall_model.h"

#include <boost/container/static_vector.hpp>

#include <cstdint>

namespace wiimote_tracker::exposure_clock {

/// ClockFilters, one per delay model, weighted by their likelihoods (multiple model estimation:
/// Magill, IEEE Trans. Autom. Control 10, 1965).
class FilterBank {
 public:
  /// @param period nominal time between frames [s].
  explicit FilterBank(double period);

  /// Resets the phase of all filters: `frame` arrived at `arrival` [s].
  void start(std::int64_t frame, double arrival);
  /// Bayes' rule for the models, the clock of each, and the number of a report's frame.
  /// @param numbers as predicted. @returns the density that was predicted for the arrival [1/s].
  double update(const StallModel::Arrival& arrival,
                const StallModel& stalls,
                FrameCounter* numbers);
  /// As ClockFilter::learn(). It counts the reports: after some it is known how a link delays them.
  void learn(std::int64_t frame, double arrival, double on_time);
  void copyReportsFrom(const FilterBank& other) { reports_ = other.reports_; }
  /// Predicts the states of `frame`; filters that have become unlikely follow the best one.
  void advanceTo(std::int64_t frame);

  const ClockFilter& best() const;
  /// Probability that the delays are exponential.
  double exponentialProbability() const;
  /// Over all models; of the states' frame.
  struct Mean {
    double time = 0.0, variance = 0.0;  ///< [s], [s^2]
    double period = 0.0, spread = 0.0;  ///< [s]
  };
  Mean mean() const;

 private:
  static constexpr int kModels = 9;
  struct Model {
    ClockFilter filter;
    double weight;
  };
  void normalise();
  bool linkIsKnown() const;

  boost::container::static_vector<Model, kModels> models_;
  int reports_ = 0;  // of the link, that were learnt from
};

}  // namespace wiimote_tracker::exposure_clock
