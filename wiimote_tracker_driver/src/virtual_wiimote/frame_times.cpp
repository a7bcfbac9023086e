#include "wiimote_tracker_driver/virtual_wiimote/frame_times.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::virtual_wiimote {

namespace {
constexpr double kWanderTime = 10.0;
constexpr double kNormalMean = 3.4;  // standard deviations
// Least time between the departures of two reports [s].
constexpr double kServiceTime = 0.3e-3;
constexpr double kNever = -std::numeric_limits<double>::infinity();
}  // namespace

FrameTimes::FrameTimes(const FrameTimesModel& model, std::uint64_t seed)
    : model_(model), random_(seed), stall_end_(kNever), last_arrival_(kNever) {
  period_ = model.period * (1.0 + model.period_tolerance * (2.0 * uniform() - 1.0));
  wander_per_frame_ = model.wander * std::sqrt(period_ / kWanderTime);
  slot_phase_ = uniform() * model.slot;
}

double FrameTimes::uniform() {
  return std::uniform_real_distribution<double>(0.0, 1.0)(random_);
}

double FrameTimes::delay() {
  if (model_.core == FrameTimesModel::Core::kNormal)
    return model_.delay + std::max(0.0, model_.jitter * (kNormalMean + normal_(random_)));
  return model_.delay + model_.jitter * std::exponential_distribution<double>(1.0)(random_);
}

// Each frame draws the same random numbers: a stall or loss does not change the others.
FrameTime FrameTimes::next() {
  FrameTime time;
  time.frame = frame_++;
  time.exposure = model_.phase + static_cast<double>(time.frame) * period_ + wandered_;
  wandered_ += wander_per_frame_ * normal_(random_);
  const double ready = time.exposure + delay();

  const bool stalled = uniform() < model_.stalls * period_;
  const double stall_length = model_.longest_stall * uniform();
  if (stalled)
    stall_end_ = std::max(stall_end_, ready + stall_length);

  // The mean run of losses is 1 / (1 - burst).
  const double first_loss = model_.drops * (1.0 - model_.burst) / (1.0 - model_.drops);
  losing_ = uniform() < (losing_ ? model_.burst : first_loss);
  time.lost = losing_;
  if (time.lost)
    return time;

  time.arrival = std::max({ready, last_arrival_ + kServiceTime, stall_end_});
  time.queued = time.arrival > ready;
  if (model_.slot > 0.0)
    time.arrival =
        slot_phase_ + model_.slot * std::ceil((time.arrival - slot_phase_) / model_.slot);
  last_arrival_ = time.arrival;
  return time;
}

}  // namespace wiimote_tracker::virtual_wiimote
