#include "computer_clocks.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::tracking {

ComputerClocks::ComputerClocks(std::size_t cameras) : cameras_(cameras), pairs_(cameras * cameras) {
  for (Camera& camera : cameras_)
    camera.unanswered.assign(cameras, 0);
}

bool ComputerClocks::add(std::size_t camera, double arrival) {
  if (comparePairs(camera, arrival))
    vote();
  const bool is_outlier = isOutlier(camera, arrival);
  noteNewest(arrival, &cameras_[camera]);
  if (!cameras_[camera].trusted || is_outlier)
    return false;
  cameras_[camera].used = arrival;
  return true;
}

/// One image that is older than those before does not set the camera back; two in a row do.
void ComputerClocks::noteNewest(double arrival, Camera* camera) {
  const bool is_behind = camera->newest && arrival < *camera->newest - kTolerance;
  if (is_behind ? camera->was_behind : !camera->newest || arrival > *camera->newest)
    camera->newest = arrival;
  camera->was_behind = is_behind;
}

void ComputerClocks::Pair::add(double lead) {
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

std::size_t ComputerClocks::indexOf(std::size_t a, std::size_t b) const {
  return std::min(a, b) * cameras_.size() + std::max(a, b);
}

/// Null while one of the two is silent, or if they are one.
const ComputerClocks::Pair* ComputerClocks::activePair(std::size_t a, std::size_t b) const {
  const Pair& pair = pairs_[indexOf(a, b)];
  return pair.recent[0].count > 0 && cameras_[a].unanswered[b] <= kSilence &&
                 cameras_[b].unanswered[a] <= kSilence
             ? &pair
             : nullptr;
}

bool ComputerClocks::doAgree(std::size_t a, std::size_t b) const {
  const Pair* pair = activePair(a, b);
  return pair && pair->agrees;
}

/// Compares the camera's new image with the others' newest. @returns whether anything changed that
/// matters for vote().
bool ComputerClocks::comparePairs(std::size_t camera, double arrival) {
  bool changed = false;
  for (std::size_t other = 0; other < cameras_.size(); ++other) {
    if (other == camera || !cameras_[other].newest)
      continue;
    Pair& pair = pairs_[indexOf(camera, other)];
    int& unanswered = cameras_[camera].unanswered[other];
    int& other_unanswered = cameras_[other].unanswered[camera];
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
    pair.add(camera < other ? lead : -lead);
    changed |= agreed != pair.agrees;
  }
  return changed;
}

void ComputerClocks::vote() {
  const std::size_t n = cameras_.size();
  for (std::size_t i = 0; i < n; ++i) {
    cameras_[i].votes = 1;
    for (std::size_t j = 0; j < n; ++j)
      cameras_[i].votes += doAgree(i, j);
  }
  for (std::size_t i = 0; i < n; ++i) {
    Camera& camera = cameras_[i];
    camera.trusted = true;
    for (std::size_t j = 0; j < n; ++j) {
      const Pair* pair = activePair(i, j);
      const std::size_t votes = cameras_[j].votes;
      if (pair && !pair->agrees &&
          (votes > camera.votes || (votes == camera.votes && !someAgreesWith(i, j))))
        camera.trusted = false;
    }
  }
}

/// Whether a camera agrees with both. Then these two are not of two groups: when a network becomes
/// slow, its camera disagrees with one of the others first.
bool ComputerClocks::someAgreesWith(std::size_t a, std::size_t b) const {
  for (std::size_t other = 0; other < cameras_.size(); ++other) {
    if (doAgree(a, other) && doAgree(b, other))
      return true;
  }
  return false;
}

/// Whether a camera's image is ahead of most others' and also of its own last one. (If only the
/// others are delayed, it is not.)
bool ComputerClocks::isOutlier(std::size_t camera, double arrival) const {
  const std::optional<double>& used = cameras_[camera].used;
  if (used && arrival <= *used + kTolerance)
    return false;
  int ahead_of = 0;
  int compared = 0;
  for (std::size_t other = 0; other < cameras_.size(); ++other) {
    if (!cameras_[other].trusted || !areActive(camera, other) ||
        cameras_[camera].unanswered[other] > kRecent)
      continue;
    ++compared;
    ahead_of += arrival > *cameras_[other].newest + kTolerance;
  }
  return 2 * ahead_of > compared;
}

std::optional<double> ComputerClocks::ahead(std::size_t camera) const {
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
