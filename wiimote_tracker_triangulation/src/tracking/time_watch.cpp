#include "tracking/time_watch.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::tracking {

TimeWatch::Result TimeWatch::check(std::size_t camera, double time, double arrival) {
  in_a_row_ = camera == last_camera_ ? in_a_row_ + 1 : 1;
  last_camera_ = camera;
  Newest& newest = cameras_[camera];
  // Per camera: the clocks of two computers may differ by more than kJump.
  if (arrival < newest.arrival - kJump) {
    newest = Newest();
    newest.jumped = true;
  }
  newest.time = std::max(newest.time, time);
  newest.arrival = std::max(newest.arrival, arrival);
  const bool is_behind = time < used_until_ - kJump;
  newest.jumped = newest.jumped && is_behind;
  ++images_since_progress_;
  // No camera continued from before the jump.
  const bool all_jumped = newest.jumped && images_since_progress_ > 2 * cameras_.size();
  if (all_jumped) {
    for (Newest& other : cameras_) {
      if (!other.jumped)
        other = Newest();
      other.jumped = false;
    }
    newest_arrival_ = arrival;
  }
  disordered_ = arrival < newest_arrival_;
  newest_arrival_ = std::max(newest_arrival_, arrival);
  const bool came_first = is_behind && countNear(time) >= 2 && countNear(used_until_) <= 1;
  if (all_jumped || came_first) {
    used_until_ = time;
    images_since_progress_ = 0;
    return Result::kJumpedBack;
  }
  if (newest.jumped)
    return Result::kWrongClock;
  double others = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    if (i != camera)
      others = std::max(others, cameras_[i].time);
  }
  const bool others_known = others > -std::numeric_limits<double>::infinity();
  if (others_known && time > others + kJump && in_a_row_ <= kSilence)
    return Result::kWrongClock;
  if (time > used_until_) {
    used_until_ = time;
    images_since_progress_ = 0;
  }
  return Result::kUsable;
}

/// Number of cameras whose newest image is within kJump of a time.
std::size_t TimeWatch::countNear(double time) const {
  return static_cast<std::size_t>(
      std::count_if(cameras_.begin(), cameras_.end(),
                    [&](const Newest& newest) { return std::fabs(newest.time - time) <= kJump; }));
}

}  // namespace wiimote_tracker::tracking
