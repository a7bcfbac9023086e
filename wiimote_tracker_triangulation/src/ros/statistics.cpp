#include "statistics.h"

#include <algorithm>
#include <limits>

namespace wiimote_tracker {

void Statistics::add(const fusion::Instant& instant, double latency) {
  constexpr std::size_t kMaximumLatencies = 100000;  // nobody may ever clear
  ++instants_;
  points_ += instant.point.has_value();
  used_.resize(instant.sightings.size());
  for (std::size_t i = 0; i < used_.size(); ++i)
    used_[i] += instant.sightings[i].used;
  if (latencies_.size() < kMaximumLatencies)
    latencies_.push_back(latency);
}

void Statistics::clear(std::size_t cameras) {
  instants_ = 0;
  points_ = 0;
  used_.assign(cameras, 0);
  latencies_.clear();
}

double Statistics::shareUsed(std::size_t camera) const {
  if (instants_ == 0 || camera >= used_.size())
    return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(used_[camera]) / static_cast<double>(instants_);
}

double Statistics::latency(double q) const {
  if (latencies_.empty())
    return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sorted = latencies_;
  const auto place =
      sorted.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), place, sorted.end());
  return *place;
}

}  // namespace wiimote_tracker
