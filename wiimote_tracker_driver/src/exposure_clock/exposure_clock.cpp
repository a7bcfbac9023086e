#include "wiimote_tracker_driver/exposure_clock/exposure_clock.h"

#include "exposure_clock/clock_estimator.h"
#include "exposure_clock/poll_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::exposure_clock {
namespace {

// A challenger learns for so long without being compared [s].
constexpr double kLearning = 0.3;
// It begins anew when its likelihood, relative to the leader's, has not doubled for so long [s].
constexpr double kTrial = 2.0;
const double kProgress = std::log(2.0);
// Logarithm of the likelihood ratio at which it becomes the leader: 1000 to 1.
constexpr double kBetter = 6.9;
// Time over which the errors of replaced leaders are averaged [s].
constexpr double kErrorMemory = 30.0;
// Between two exposures, where a frame number was corrected downwards [s].
constexpr double kShortestStep = 1e-6;

}  // namespace

ExposureClock::ExposureClock(double period)
    : leader_(std::make_unique<ClockEstimator>(period)),
      challenger_(std::make_unique<ClockEstimator>(period)),
      polls_(std::make_unique<PollWatch>()),
      progressed_at_(-std::numeric_limits<double>::infinity()),
      leader_begin_(std::numeric_limits<double>::infinity()),
      last_arrival_(progressed_at_),
      last_exposure_(last_arrival_) {}

ExposureClock::~ExposureClock() = default;
ExposureClock::ExposureClock(ExposureClock&&) noexcept = default;
ExposureClock& ExposureClock::operator=(ExposureClock&&) noexcept = default;

void ExposureClock::reset() {
  *this = ExposureClock(leader_->nominalPeriod());
}

Estimate ExposureClock::update(double arrival, bool waited) {
  Estimate e = leader_->update(arrival, waited);
  leader_begin_ = std::min(leader_begin_, arrival);
  if (!waited)
    polls_->add(arrival);
  if (arrival > last_arrival_)
    error_variance_ *= std::exp((last_arrival_ - arrival) / kErrorMemory);
  e.frame += frame_offset_;
  if (e.restarted)
    endTrial();
  const Estimate other = challenge(arrival, waited);
  if (advantage_ > kBetter) {
    frame_offset_ = e.frame - other.frame;
    learnError(other.exposure - e.exposure, arrival);
    *leader_ = *challenger_;
    e.exposure = other.exposure;
    e.stddev = other.stddev;
    e.clock_stddev = other.clock_stddev;
    e.restarted = true;
    endTrial();
  }
  const double hidden = std::sqrt(error_variance_ + polls_->waitVariance());
  e.stddev = std::hypot(e.stddev, hidden);
  e.clock_stddev = std::hypot(e.clock_stddev, hidden);
  // Exposures follow a clock that stepped back; otherwise they increase.
  const bool stepped_back = e.restarted && arrival < last_arrival_;
  const double earliest = last_exposure_ + kShortestStep;
  if (!stepped_back && e.exposure < earliest) {
    e.stddev = std::hypot(e.stddev, earliest - e.exposure);
    e.exposure = earliest;
  }
  last_arrival_ = arrival;
  last_exposure_ = e.exposure;
  ++counts_.reports;
  counts_.dropped = e.frame + 1 - static_cast<std::int64_t>(counts_.reports);
  counts_.stale += e.stale;
  counts_.restarts += e.restarted;
  return e;
}

void ExposureClock::learnError(double error, double arrival) {
  const double share = 1.0 - std::exp((leader_begin_ - arrival) / kErrorMemory);
  error_variance_ += share * error * error / 3.0;
  leader_begin_ = arrival;
}

void ExposureClock::endTrial() {
  progressed_at_ = -std::numeric_limits<double>::infinity();
  advantage_ = 0.0;
}

Estimate ExposureClock::challenge(double arrival, bool waited) {
  // It begins with an arrival, which a report that waited does not have.
  if (arrival < last_arrival_ || (!waited && arrival > progressed_at_ + kTrial)) {
    *challenger_ = ClockEstimator(challenger_->nominalPeriod());
    challenger_->copyLinkFrom(*leader_);
    trial_begin_ = progressed_at_ = arrival;
    advantage_ = best_advantage_ = 0.0;
  }
  const Estimate estimate = challenger_->update(arrival, waited);
  if (arrival > trial_begin_ + kLearning)
    advantage_ += challenger_->logEvidence() - leader_->logEvidence();
  if (advantage_ > best_advantage_ + kProgress) {
    best_advantage_ = advantage_;
    progressed_at_ = arrival;
  }
  return estimate;
}

Statistics ExposureClock::statistics() const {
  Statistics s = leader_->statistics();
  s.dropped = counts_.dropped;
  s.reports = counts_.reports;
  s.stale = counts_.stale;
  s.restarts = counts_.restarts;
  return s;
}

}  // namespace wiimote_tracker::exposure_clock
