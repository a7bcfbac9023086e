#include "tracking/arrival_clocks.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::tracking {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

ImageTimes timesOf(const geometry::RigCamera& camera, const CameraImage& image) {
  const double offset = camera.timeOffsetIn(image.clock_epoch).value_or(0.0);
  return {image.stamp + offset, image.arrival + offset};
}

ArrivalClocks::ArrivalClocks(std::size_t cameras, double newest_used)
    : cameras_(cameras),
      pairs_(cameras * cameras),
      votes_(cameras),
      newest_used_(newest_used),
      awaited_(newest_used > -kInfinity ? 2 * cameras : 0) {
  for (Camera& camera : cameras_)
    camera.in_step_until = newest_used;
}

ArrivalClocks::Result ArrivalClocks::check(std::size_t camera, const ImageTimes& times) {
  disordered_ = false;
  const double arrival = times.arrival;
  if (!std::isfinite(times.exposure) || !std::isfinite(arrival))
    return Result::kWrongClock;
  if (awaited_ > 0)
    --awaited_;
  if (comparePairs(camera, arrival))
    vote();
  const bool is_outlier = isOutlier(camera, arrival);
  noteNewest(arrival, &cameras_[camera]);
  if (!cameras_[camera].trusted || is_outlier)
    return Result::kWrongClock;
  cameras_[camera].used = arrival;
  const bool jumped_back = hasJumpedBack(camera);
  if (jumped_back) {
    for (Camera& each : cameras_)
      each.in_step_until = -kInfinity;
  }
  noteStep(arrival, jumped_back || arrival >= newest_used_ - kJump, &cameras_[camera]);
  disordered_ = !jumped_back && arrival < newest_used_;
  if (jumped_back || arrival >= newest_used_) {
    newest_used_ = arrival;
    newest_camera_ = camera;
  }
  return jumped_back ? Result::kJumpedBack : Result::kUsable;
}

/// One image that is older than those before does not set the camera back; two in a row do.
void ArrivalClocks::noteNewest(double arrival, Camera* camera) {
  const bool is_behind = camera->newest && arrival < *camera->newest - kTolerance;
  if (is_behind ? camera->was_behind : arrival > camera->newest.value_or(-kInfinity))
    camera->newest = arrival;
  camera->was_behind = is_behind;
}

void ArrivalClocks::noteStep(double arrival, bool is_in_step, Camera* camera) {
  if (is_in_step) {
    camera->in_step_until = std::max(camera->in_step_until, arrival);
    camera->images_behind = 0;
  } else if (camera->images_behind <= kLongestBacklog) {  // more would overflow some day
    ++camera->images_behind;
  }
}

void ArrivalClocks::Pair::add(double lead) {
  if (recent[0].count == kWindow) {
    recent[1] = recent[0];
    recent[0] = Leads();
  }
  ++recent[0].count;
  recent[0].near += std::abs(lead) <= kTolerance;
  recent[0].sum += lead;
  const int total = recent[0].count + recent[1].count;
  if (total >= kLeast)
    agrees = 4 * (recent[0].near + recent[1].near) > total;
}

std::size_t ArrivalClocks::indexOf(std::size_t a, std::size_t b) const {
  return std::min(a, b) * cameras_.size() + std::max(a, b);
}

/// Nothing while one of the two is silent, or if they are one.
const ArrivalClocks::Pair* ArrivalClocks::activePair(std::size_t a, std::size_t b) const {
  const Pair& pair = pairs_[indexOf(a, b)];
  return pair.recent[0].count > 0 && pair.unanswered[0] <= kSilence &&
                 pair.unanswered[1] <= kSilence
             ? &pair
             : nullptr;
}

bool ArrivalClocks::doAgree(std::size_t a, std::size_t b) const {
  const Pair* pair = activePair(a, b);
  return pair && pair->agrees;
}

/// Compares the camera's new image with the others' newest. @returns whether anything changed that
/// matters for vote().
bool ArrivalClocks::comparePairs(std::size_t camera, double arrival) {
  bool changed = false;
  for (std::size_t other = 0; other < cameras_.size(); ++other) {
    if (other == camera || !cameras_[other].newest)
      continue;
    Pair& pair = pairs_[indexOf(camera, other)];
    const bool is_first = camera < other;
    int& unanswered = pair.unanswered[is_first ? 0 : 1];
    int& other_unanswered = pair.unanswered[is_first ? 1 : 0];
    const bool was_silent = other_unanswered > kSilence;
    unanswered = std::min(unanswered + 1, kSilence + 2);  // more would overflow some day
    changed |= was_silent || unanswered == kSilence + 1;
    if (was_silent)
      pair.recent = {};
    other_unanswered = 0;
    if (unanswered > 1)
      continue;
    const double lead = arrival - *cameras_[other].newest;
    const bool agreed = pair.agrees;
    pair.add(is_first ? lead : -lead);
    changed |= agreed != pair.agrees;
  }
  return changed;
}

void ArrivalClocks::vote() {
  const std::size_t n = cameras_.size();
  for (std::size_t i = 0; i < n; ++i) {
    votes_[i] = 1;
    for (std::size_t j = 0; j < n; ++j)
      votes_[i] += doAgree(i, j);
  }
  for (std::size_t i = 0; i < n; ++i) {
    cameras_[i].trusted = true;
    for (std::size_t j = 0; j < n; ++j) {
      const Pair* pair = activePair(i, j);
      if (pair && !pair->agrees &&
          (votes_[j] > votes_[i] || (votes_[j] == votes_[i] && !someAgreesWith(i, j))))
        cameras_[i].trusted = false;
    }
  }
}

/// Whether a camera agrees with both. Then these two are not of two groups: when a network becomes
/// slow, its camera disagrees with one of the others first.
bool ArrivalClocks::someAgreesWith(std::size_t a, std::size_t b) const {
  for (std::size_t other = 0; other < cameras_.size(); ++other) {
    if (doAgree(a, other) && doAgree(b, other))
      return true;
  }
  return false;
}

/// Whether a camera's image is ahead of most others' and also of its own last one. (If only the
/// others are delayed, it is not.)
bool ArrivalClocks::isOutlier(std::size_t camera, double arrival) const {
  const std::optional<double>& used = cameras_[camera].used;
  if (used && arrival <= *used + kTolerance)
    return false;
  int ahead_of = 0;
  int compared = 0;
  for (std::size_t other = 0; other < cameras_.size(); ++other) {
    const Pair* pair = activePair(camera, other);
    if (!cameras_[other].trusted || !pair || pair->unanswered[camera < other ? 0 : 1] > kRecent)
      continue;
    ++compared;
    ahead_of += arrival > *cameras_[other].newest + kTolerance;
  }
  return 2 * ahead_of > compared;
}

/// Whether all trusted cameras that are not silent are back behind the newest image that was used,
/// or that image came from a camera that is not trusted any more. Images that only waited in a
/// network are no jump, though they may be so many together that the others seem silent.
bool ArrivalClocks::hasJumpedBack(std::size_t camera) const {
  if (awaited_ > 0)
    return false;
  const bool is_trusted = cameras_[newest_camera_].trusted;
  const double jump = is_trusted ? kJump : kTolerance;
  if (is_trusted && isBacklog(cameras_[camera]))
    return false;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    const bool counts = i == camera || (cameras_[i].trusted && activePair(camera, i));
    if (counts && !(*cameras_[i].newest < newest_used_ - jump))
      return false;
  }
  return true;
}

/// Whether its images go on where they were when the camera was last with the others.
bool ArrivalClocks::isBacklog(const Camera& camera) {
  return camera.in_step_until > -kInfinity && *camera.newest >= camera.in_step_until - kTolerance &&
         camera.images_behind <= kLongestBacklog;
}

std::optional<double> ArrivalClocks::ahead(std::size_t camera) const {
  if (cameras_[camera].trusted)
    return std::nullopt;
  double sum = 0.0;
  int count = 0;
  for (std::size_t other = 0; other < cameras_.size(); ++other) {
    const Pair* pair = activePair(camera, other);
    if (!pair || !cameras_[other].trusted)
      continue;
    const double lead = pair->meanLead();
    sum += camera < other ? lead : -lead;
    ++count;
  }
  return sum / count;  // NaN: none
}

}  // namespace wiimote_tracker::tracking
