#include "continuous/suspect_watch.h"

namespace wiimote_tracker::continuous {

SuspectWatch::SuspectWatch(const geometry::Rig& rig, const SuspectOptions& options)
    : rig_(rig),
      watch_(rig, options.drift),
      alarms_(rig.cameras.size()),
      new_clocks_(rig.cameras.size(), false),
      motion_(options.motion) {}

std::optional<Evidence> SuspectWatch::add(const capture::Image& image) {
  const geometry::RigCamera* const camera = rig_.find(image.camera);
  if (camera == nullptr)
    return std::nullopt;
  new_clocks_[static_cast<std::size_t>(camera - rig_.cameras.data())] =
      camera->hasNewClock(image.clock_epoch);
  if (watch_.add(image))
    judge();
  if (!suspect_ || !motion_.add(image, rig_.cameras[*suspect_].camera.name))
    return std::nullopt;
  return Evidence{*suspect_, new_clocks_[*suspect_], motion_.images(), gravity_.mean()};
}

std::vector<std::string> SuspectWatch::newClocks() const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < new_clocks_.size(); ++i) {
    if (new_clocks_[i])
      names.push_back(rig_.cameras[i].camera.name);
  }
  return names;
}

void SuspectWatch::addAcceleration(const std::string& camera,
                                   const Eigen::Vector3d& specific_force) {
  if (isSuspect(camera))
    gravity_.add(specific_force);
}

void SuspectWatch::judge() {
  for (std::size_t i = 0; i < alarms_.size(); ++i) {
    // Of two cameras that contradict each other neither is known to be the one.
    if (const auto& drift = watch_.drifts()[i])
      alarms_[i].judge(drift->or_camera.empty() ? drift->ratio : 0.0);
  }
  const auto suspect = onlySuspect();
  if (suspect == suspect_)
    return;
  suspect_ = suspect;
  motion_.clear();
  gravity_ = capture::RestGravity();
}

std::optional<std::size_t> SuspectWatch::onlySuspect() const {
  std::vector<std::size_t> off;
  std::vector<std::size_t> reconnected;
  for (std::size_t i = 0; i < alarms_.size(); ++i) {
    if (alarms_[i].on())
      off.push_back(i);
    if (new_clocks_[i])
      reconnected.push_back(i);
  }
  const std::vector<std::size_t>& suspects = reconnected.empty() ? off : reconnected;
  return suspects.size() == 1 ? std::optional(suspects.front()) : std::nullopt;
}

}  // namespace wiimote_tracker::continuous
