#include "wiimote_tracker_triangulation/tracking/time_watch.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::tracking {

TimeWatch::Verdict TimeWatch::look(std::size_t camera, double time, double arrival) {
  in_a_row_ = camera == last_camera_ ? in_a_row_ + 1 : 1;
  last_camera_ = camera;
  // By each camera's own clock: those of two computers may differ by more than a jump.
  const bool jumped = arrival < cameras_[camera].arrival - kJump;
  if (jumped) {
    std::fill(cameras_.begin(), cameras_.end(), Newest());
    newest_arrival_ = -std::numeric_limits<double>::infinity();
  }
  disordered_ = arrival < newest_arrival_;
  newest_arrival_ = std::max(newest_arrival_, arrival);
  Newest& newest = cameras_[camera];
  newest.time = std::max(newest.time, time);
  newest.arrival = std::max(newest.arrival, arrival);
  const bool came_first =
      time < used_until_ - kJump && countNear(time) >= 2 && countNear(used_until_) <= 1;
  if (jumped || came_first) {
    used_until_ = time;
    return Verdict::kJumpedBack;
  }
  double others = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    if (i != camera)
      others = std::max(others, cameras_[i].time);
  }
  const bool others_known = others > -std::numeric_limits<double>::infinity();
  if (others_known && time > others + kJump && in_a_row_ <= kSilence)
    return Verdict::kAhead;
  used_until_ = std::max(used_until_, time);
  return Verdict::kUsable;
}

/// Cameras whose newest image is of about this time.
std::size_t TimeWatch::countNear(double time) const {
  return static_cast<std::size_t>(
      std::count_if(cameras_.begin(), cameras_.end(),
                    [&](const Newest& newest) { return std::fabs(newest.time - time) <= kJump; }));
}

}  // namespace wiimote_tracker::tracking
