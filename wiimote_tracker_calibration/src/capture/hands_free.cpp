#include "capture/hands_free.h"

#include "capture/camera_monitor.h"

#include <algorithm>

namespace wiimote_tracker::capture {

namespace {

// A still spot stays within this distance of where it came to rest [px].
constexpr double kStill = 3.0;
// Longest gap between detections of a still LED [s].
constexpr double kDropOut = 0.3;

}  // namespace

HandsFree::HandsFree(const std::vector<std::string>& cameras, const HandsFreeOptions& options)
    : options_(options) {
  for (const std::string& name : cameras)
    cameras_[name];
}

void HandsFree::restart() {
  for (auto& camera : cameras_)
    camera.second = Camera();
}

bool HandsFree::add(const Image& image, const std::vector<CapturedCorner>& captured) {
  const auto found = cameras_.find(image.camera);
  if (found == cameras_.end())
    return false;
  Camera& camera = found->second;
  // By its own stamps: the clocks of others may be ahead.
  if (image.stamp < camera.latest - kLongestDelay)
    restart();  // time jumped back
  if (image.spots.size() == 1 && image.spots.front().allFinite()) {
    const Eigen::Vector2d& spot = image.spots.front();
    if (!camera.seen || image.stamp > camera.latest + kDropOut ||
        (spot - camera.pixel).norm() > kStill) {
      camera.since = image.stamp;
      camera.pixel = spot;
    }
    camera.seen = true;
    camera.latest = image.stamp;
  }

  int still = 0;
  for (auto& entry : cameras_) {
    Camera& each = entry.second;
    each.seen = each.seen && each.latest >= image.stamp - kDropOut;
    if (!each.seen)
      continue;
    if (image.stamp - each.since < options_.hold)
      return false;
    ++still;
  }
  return still >= options_.minimum_cameras &&
         std::all_of(captured.begin(), captured.end(),
                     [this](const CapturedCorner& corner) { return isNew(corner); });
}

/// Whether a camera that saw the corner sees the LED elsewhere, or none that saw it sees the LED.
bool HandsFree::isNew(const CapturedCorner& corner) const {
  bool seen_by_both = false;
  for (const auto& view : corner) {
    const auto found = cameras_.find(view.first);
    if (found == cameras_.end() || !found->second.seen)
      continue;
    seen_by_both = true;
    if ((found->second.pixel - view.second.pixel).norm() > options_.distance)
      return true;
  }
  return !seen_by_both;
}

}  // namespace wiimote_tracker::capture
