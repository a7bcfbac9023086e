#include "continuous/suspect_watch.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::continuous {

namespace {

// Images are collected as long as the last sample is not older than this [s].
constexpr double kLongestPause = 1.0;
// The camera and two others.
constexpr std::size_t kLeastViews = 3;

}  // namespace

SuspectWatch::SuspectWatch(const geometry::Rig& rig, const SuspectOptions& options)
    : options_(options), watch_(rig, options.drift), alarms_(rig.cameras.size()) {
  for (const geometry::RigCamera& camera : rig.cameras)
    names_.push_back(camera.camera.name);
}

std::optional<Evidence> SuspectWatch::add(const capture::Image& image) {
  if (watch_.add(image))
    judge();
  if (!suspect_ || !countMotion(image.stamp))
    return std::nullopt;
  images_.push_back(image);
  if (motion_.size() < options_.to_solve + options_.to_check || unused_ < options_.to_check)
    return std::nullopt;
  forgetSurplus();
  unused_ = 0;
  return evidence();
}

void SuspectWatch::addAcceleration(const std::string& camera,
                                   const Eigen::Vector3d& specific_force) {
  if (isSuspect(camera))
    gravity_.add(specific_force);
}

void SuspectWatch::judge() {
  std::optional<std::size_t> only;
  int count = 0;
  for (std::size_t i = 0; i < alarms_.size(); ++i) {
    // Of two cameras that contradict each other neither is known to be the one.
    if (const auto& drift = watch_.drifts()[i])
      alarms_[i].judge(drift->together.empty() ? drift->ratio : 0.0);
    if (!alarms_[i].on())
      continue;
    only = i;
    ++count;
  }
  const std::optional<std::size_t> suspect = count == 1 ? only : std::nullopt;
  if (suspect != suspect_)
    collectFor(suspect);
}

void SuspectWatch::collectFor(std::optional<std::size_t> suspect) {
  suspect_ = suspect;
  images_.clear();
  motion_.clear();
  unused_ = 0;
  gravity_ = capture::RestGravity();
}

bool SuspectWatch::countMotion(double time) {
  if (watch_.samples().empty())
    return false;
  const health::DriftSample& newest = watch_.samples().back();
  if (!motion_.empty() && newest.time < motion_.back())
    collectFor(suspect_);  // time jumped back
  const bool takes_part = std::any_of(newest.sights.begin(), newest.sights.end(),
                                      [&](const auto& sight) { return sight.first == *suspect_; });
  if (takes_part && newest.sights.size() >= kLeastViews &&
      (motion_.empty() || newest.time > motion_.back())) {
    motion_.push_back(newest.time);
    ++unused_;
  }
  return !motion_.empty() && std::abs(time - motion_.back()) < kLongestPause;
}

void SuspectWatch::forgetSurplus() {
  while (motion_.size() > options_.to_solve + options_.to_check)
    motion_.pop_front();
  while (!images_.empty() && images_.front().stamp < motion_.front())
    images_.pop_front();
}

Evidence SuspectWatch::evidence() const {
  Evidence evidence;
  evidence.camera = names_[*suspect_];
  const double split = motion_[options_.to_solve];
  for (const capture::Image& image : images_)
    (image.stamp < split ? evidence.to_solve : evidence.to_check).push_back(image);
  evidence.gravity = gravity_.mean();
  return evidence;
}

}  // namespace wiimote_tracker::continuous
