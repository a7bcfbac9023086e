#include "tracking/image_intake.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::tracking {
namespace {

// More images of one camera do not wait in a network: about half a minute.
constexpr int kLongestBacklog = 3000;

/// What to add to the times of a camera's images [s].
double offsetIn(std::uint32_t clock_epoch, const geometry::RigCamera& camera) {
  return camera.timeOffsetIn(clock_epoch).value_or(0.0);
}

}  // namespace

bool ImageIntake::setRig(const geometry::Rig& rig) {
  const std::size_t cameras = rig.cameras.size();
  const bool keeps_times = keepsTimes(rig);
  if (!keeps_times || !geometry::haveSameCameras(rig_, rig)) {
    clocks_ = ComputerClocks(cameras);
    progress_.assign(cameras, {newest_used_});
    newest_camera_ = 0;
    awaited_ = newest_used_ > kNever ? 2 * cameras : 0;
  }
  rig_ = rig;
  return keeps_times;
}

/// Whether each camera's next image, in the epoch of its last one, has nearly the same offset.
bool ImageIntake::keepsTimes(const geometry::Rig& rig) const {
  constexpr double kOffsetJump = 0.05;  // images before and after it cannot be combined [s]
  for (std::size_t i = 0; i < progress_.size(); ++i) {
    const geometry::RigCamera& before = rig_.cameras[i];
    const geometry::RigCamera* const now = rig.find(before.camera.name);
    const std::optional<std::uint32_t> epoch = progress_[i].clock_epoch;
    if (now && epoch &&
        !(std::abs(offsetIn(*epoch, *now) - offsetIn(*epoch, before)) < kOffsetJump))
      return false;
  }
  return true;
}

ImageIntake::Result ImageIntake::take(std::size_t camera,
                                      const CameraImage& image,
                                      const ClockError& clock,
                                      TimedImage* timed) {
  disordered_ = false;
  const double offset = offsetIn(image.clock_epoch, rig_.cameras.at(camera));
  const double exposure = image.stamp + offset;
  const double arrival = image.arrival + offset;
  if (!std::isfinite(exposure) || !std::isfinite(arrival))
    return Result::kWrongClock;
  const double stddev = std::isnan(image.stamp_stddev) ? stamp_stddev_ : image.stamp_stddev;
  timed->camera = camera;
  timed->time = exposure - clock.offset;
  timed->arrival = image.arrival;
  timed->stamp_stddev = std::hypot(stddev, std::sqrt(clock.variance));
  const Result result = judge(camera, arrival);
  progress_[camera].clock_epoch = image.clock_epoch;
  return result;
}

ImageIntake::Result ImageIntake::judge(std::size_t camera, double arrival) {
  if (awaited_ > 0)
    --awaited_;
  if (!clocks_.add(camera, arrival))
    return Result::kWrongClock;
  const bool jumped_back = hasJumpedBack(camera);
  if (jumped_back)
    progress_.assign(progress_.size(), {kNever});
  progress_[camera].add(arrival, jumped_back || arrival >= newest_used_ - kJump);
  disordered_ = !jumped_back && arrival < newest_used_;
  if (jumped_back || arrival >= newest_used_) {
    newest_used_ = arrival;
    newest_camera_ = camera;
  }
  return jumped_back ? Result::kJumpedBack : Result::kUsable;
}

void ImageIntake::Progress::add(double arrival, bool is_in_step) {
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
bool ImageIntake::hasJumpedBack(std::size_t camera) const {
  if (awaited_ > 0)
    return false;
  const bool is_trusted = clocks_.isTrusted(newest_camera_);
  if (is_trusted && isBacklog(camera))
    return false;
  const double jump = is_trusted ? kJump : ComputerClocks::kTolerance;
  for (std::size_t i = 0; i < progress_.size(); ++i) {
    const bool counts = i == camera || (clocks_.isTrusted(i) && clocks_.areActive(camera, i));
    if (counts && !(*clocks_.newestOf(i) < newest_used_ - jump))
      return false;
  }
  return true;
}

/// Whether its images go on where they were when the camera was last in step.
bool ImageIntake::isBacklog(std::size_t camera) const {
  const Progress& progress = progress_[camera];
  return progress.in_step_until > kNever &&
         *clocks_.newestOf(camera) >= progress.in_step_until - ComputerClocks::kTolerance &&
         progress.images_behind <= kLongestBacklog;
}

}  // namespace wiimote_tracker::tracking
