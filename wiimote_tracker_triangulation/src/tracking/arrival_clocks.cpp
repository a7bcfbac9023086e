#include "tracking/arrival_clocks.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::tracking {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// More images of one camera do not wait in a network: about half a minute.
constexpr int kLongestBacklog = 3000;

}  // namespace

ImageTimes timesOf(const geometry::RigCamera& camera, const CameraImage& image) {
  const double offset = camera.timeOffsetIn(image.clock_epoch).value_or(0.0);
  return {image.stamp + offset, image.arrival + offset};
}

ArrivalClocks::ArrivalClocks(std::size_t cameras, double newest_used)
    : agreement_(cameras),
      progress_(cameras, {newest_used}),
      newest_used_(newest_used),
      awaited_(newest_used > -kInfinity ? 2 * cameras : 0) {}

ArrivalClocks::Result ArrivalClocks::check(std::size_t camera, const ImageTimes& times) {
  disordered_ = false;
  const double arrival = times.arrival;
  if (!std::isfinite(times.exposure) || !std::isfinite(arrival))
    return Result::kWrongClock;
  if (awaited_ > 0)
    --awaited_;
  if (!agreement_.add(camera, arrival))
    return Result::kWrongClock;
  const bool jumped_back = hasJumpedBack(camera);
  if (jumped_back)
    progress_.assign(progress_.size(), {-kInfinity});
  progress_[camera].add(arrival, jumped_back || arrival >= newest_used_ - kJump);
  disordered_ = !jumped_back && arrival < newest_used_;
  if (jumped_back || arrival >= newest_used_) {
    newest_used_ = arrival;
    newest_camera_ = camera;
  }
  return jumped_back ? Result::kJumpedBack : Result::kUsable;
}

void ArrivalClocks::Progress::add(double arrival, bool is_in_step) {
  if (is_in_step) {
    in_step_until = std::max(in_step_until, arrival);
    images_behind = 0;
  } else if (images_behind <= kLongestBacklog) {  // more would overflow some day
    ++images_behind;
  }
}

/// Whether all trusted cameras that are not silent are back behind the newest image that was used,
/// or that image came from a camera that is not trusted any more. Images that only waited in a
/// network are no jump, though they may be so many together that the others seem silent.
bool ArrivalClocks::hasJumpedBack(std::size_t camera) const {
  if (awaited_ > 0)
    return false;
  const bool is_trusted = agreement_.isTrusted(newest_camera_);
  if (is_trusted && isBacklog(camera))
    return false;
  const double jump = is_trusted ? kJump : ClockAgreement::kTolerance;
  for (std::size_t i = 0; i < progress_.size(); ++i) {
    const bool counts = i == camera || (agreement_.isTrusted(i) && agreement_.areActive(camera, i));
    if (counts && !(*agreement_.newestOf(i) < newest_used_ - jump))
      return false;
  }
  return true;
}

/// Whether its images go on where they were when the camera was last in step.
bool ArrivalClocks::isBacklog(std::size_t camera) const {
  const Progress& progress = progress_[camera];
  return progress.in_step_until > -kInfinity &&
         *agreement_.newestOf(camera) >= progress.in_step_until - ClockAgreement::kTolerance &&
         progress.images_behind <= kLongestBacklog;
}

}  // namespace wiimote_tracker::tracking
