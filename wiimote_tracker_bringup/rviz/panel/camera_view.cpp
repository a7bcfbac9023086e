#include "camera_view.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace wiimote_tracker::panel {
namespace {

using wiimote_tracker_msgs::IrBlob;
using wiimote_tracker_msgs::IrBlobArray;

constexpr double kRateWindow = 2.0;  // [s]
constexpr double kSmoothing = 0.2;   // share of a new image in the delay
constexpr double kOtherClock = 5.0;  // a longer delay is a wrong clock or a recording [s]

}  // namespace

void CameraView::onImage(const IrBlobArray& message, double delay, double now) {
  if (image && message.frame < image->frame)
    counts_.clear();  // the driver was started again
  delay_ = hasImages(now) ? (1.0 - kSmoothing) * delay_ + kSmoothing * delay : delay;
  image = message;
  image_at_ = now;
  counts_.push_back({now, message.frame});
  while (counts_.front().time < now - kRateWindow)
    counts_.pop_front();
  for (const IrBlob& spot : visible()) {
    lit_at_ = now;
    trail.push_back({now, spot.x, spot.y});
  }
  while (!trail.empty() && trail.front().time < now - kTrail)
    trail.pop_front();
}

CameraState CameraView::state(double now, bool others_see) const {
  if (!hasImages(now))
    return CameraState::kFrozen;
  if (!status.health.empty())
    return CameraState::kKnocked;
  if (!warning_.empty() && now - warned_at_ < kWarnedFor)
    return CameraState::kWarned;
  if (std::abs(delay_) > kLateAfter)
    return CameraState::kLate;
  if (!calibration)
    return CameraState::kNotCalibrated;
  if (others_see && now - lit_at_ > kBlindAfter)
    return CameraState::kBlind;
  return CameraState::kFine;
}

std::string CameraView::words(double now, bool others_see) const {
  switch (state(now, others_see)) {
    case CameraState::kFrozen:
      if (silence(now) < kFrozenAfter)
        return "waiting for its images";
      return format("no images for %.0f s: check battery and link", silence(now));
    case CameraState::kKnocked:
      return status.health;
    case CameraState::kWarned:
      return warning_;
    case CameraState::kLate:
      if (std::abs(delay_) > kOtherClock)
        return "its stamps are not of now: a recording, or a clock that is wrong";
      if (delay_ < 0.0)
        return format("its clock is %.0f ms ahead: run chrony on all computers", -1e3 * delay_);
      return format("images come %.0f ms late", 1e3 * delay_);
    case CameraState::kNotCalibrated:
      return "not calibrated, sees " + counted(visible().size(), "spot");
    case CameraState::kBlind:
      return format("sees no spot for %.0f s, others do", now - lit_at_);
    case CameraState::kFine:
      return "fine, sees " + counted(visible().size(), "spot");
  }
  return "unknown";
}

bool CameraView::isMasked(const IrBlob& spot) const {
  if (!calibration)
    return false;
  return std::any_of(calibration->masks.begin(), calibration->masks.end(), [&](const auto& mask) {
    return std::hypot(spot.x - mask.x, spot.y - mask.y) < mask.radius;
  });
}

std::vector<IrBlob> CameraView::visible() const {
  std::vector<IrBlob> spots;
  if (image)
    std::copy_if(image->blobs.begin(), image->blobs.end(), std::back_inserter(spots),
                 [&](const IrBlob& spot) { return !isMasked(spot); });
  return spots;
}

double CameraView::rate(double now) const {
  if (!hasImages(now) || counts_.size() < 2 || counts_.back().time <= counts_.front().time)
    return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(counts_.back().frame - counts_.front().frame) /
         (counts_.back().time - counts_.front().time);
}

}  // namespace wiimote_tracker::panel
