#include "continuous/motion_window.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::continuous {

namespace {

using capture::kSamplePeriod;

constexpr double kLeastMotion = 2.0;  // Rounding alone does not move a spot as far [px].
// Images are kept as long as the last sample is not older than this [s].
constexpr double kLongestPause = 1.0;
// Of an LED that moves slowly, only images as close to a sample are kept [s].
constexpr double kNear = 0.1;
// Samples farther from the newest image are dropped: meanwhile cameras may have drifted [s].
constexpr double kLongestSpan = 3600.0;

}  // namespace

bool MotionWindow::add(const capture::Image& image, const std::string& needed) {
  if (!samples_.empty() && image.stamp < samples_.back() - kLongestPause)
    clear();  // time jumped back
  count(image, needed);
  if (samples_.empty() || image.stamp - samples_.back() > kLongestPause)
    return false;
  images_.push_back(image);
  const std::size_t most_to_solve = std::max(options_.to_solve, options_.most_to_solve);
  while (samples_.size() > most_to_solve + options_.to_check ||
         samples_.front() < image.stamp - kLongestSpan)
    samples_.pop_front();
  while (images_.front().stamp < samples_.front() - kSamplePeriod)
    images_.pop_front();
  if (samples_.size() < options_.to_solve + options_.to_check || unused_ < options_.to_check)
    return false;
  unused_ = 0;
  return true;
}

void MotionWindow::count(const capture::Image& image, const std::string& needed) {
  const double period = std::floor(image.stamp / kSamplePeriod);
  if (period != period_)
    moved_.clear();
  period_ = period;
  if (image.spots.size() != 1 || moved_.count(image.camera) > 0)
    return;
  const Eigen::Vector2d& spot = image.spots.front();
  const auto [last, is_first] = spots_.emplace(image.camera, spot);
  if (!is_first && (spot - last->second).norm() < kLeastMotion)
    return;
  last->second = spot;
  moved_.insert(image.camera);
  // One sample for each period: later cameras of it add nothing.
  const bool complete =
      moved_.size() >= options_.cameras && (needed.empty() || moved_.count(needed) > 0);
  if (!complete || (!samples_.empty() && std::floor(samples_.back() / kSamplePeriod) == period))
    return;
  const double last_sample = samples_.empty() ? image.stamp : samples_.back();
  if (image.stamp - last_sample > 2.0 * kNear) {
    const auto is_far = [&](const capture::Image& other) {
      return other.stamp > last_sample + kNear && other.stamp < image.stamp - kNear;
    };
    images_.erase(std::remove_if(images_.begin(), images_.end(), is_far), images_.end());
  }
  samples_.push_back(image.stamp);
  ++unused_;
}

MotionImages MotionWindow::images() const {
  MotionImages images;
  const double split = samples_[samples_.size() - options_.to_check];
  for (const capture::Image& image : images_)
    (image.stamp < split ? images.to_solve : images.to_check).push_back(image);
  return images;
}

void MotionWindow::clear() {
  *this = MotionWindow(options_);
}

}  // namespace wiimote_tracker::continuous
