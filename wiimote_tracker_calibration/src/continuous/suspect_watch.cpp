#include "continuous/suspect_watch.h"

namespace wiimote_tracker::continuous {

SuspectWatch::SuspectWatch(const geometry::Rig& rig, const SuspectOptions& options)
    : rig_(rig),
      options_(options),
      watch_(rig, options.drift),
      alarms_(rig.cameras.size()),
      new_clocks_(rig.cameras.size(), false),
      motion_(options.motion),
      gravity_(rig.cameras.size()) {}

std::optional<Evidence> SuspectWatch::add(const capture::Image& image) {
  const geometry::RigCamera* const camera = rig_.find(image.camera);
  if (camera == nullptr)
    return std::nullopt;
  new_clocks_[static_cast<std::size_t>(camera - rig_.cameras.data())] =
      camera->hasNewClock(image.clock_epoch);
  if (watch_.add(image))
    judge();
  if (suspects_.empty())
    return std::nullopt;
  const bool alone = suspects_.size() == 1;
  const std::string needed = alone ? rig_.cameras[suspects_.front()].camera.name : "";
  if (!motion_.add(image, needed))
    return std::nullopt;
  Evidence evidence;
  evidence.images = motion_.images();
  for (const capture::RestGravity& gravity : gravity_)
    evidence.gravity.push_back(gravity.mean());
  if (alone) {
    evidence.camera = suspects_.front();
    evidence.new_clock = new_clocks_[suspects_.front()];
  }
  return evidence;
}

bool SuspectWatch::areSuspect(const std::vector<std::string>& cameras) const {
  if (cameras.size() > 1)
    return severalAreSuspect();
  return suspects_.size() == 1 && rig_.cameras[suspects_.front()].camera.name == cameras.front();
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
  const geometry::RigCamera* const found = rig_.find(camera);
  if (found != nullptr && !suspects_.empty())
    gravity_[static_cast<std::size_t>(found - rig_.cameras.data())].add(specific_force);
}

void SuspectWatch::judge() {
  for (std::size_t i = 0; i < alarms_.size(); ++i) {
    // Of two cameras that contradict each other neither is known to be the one.
    if (const auto& drift = watch_.drifts()[i])
      alarms_[i].judge(drift->or_camera.empty() ? drift->ratio : 0.0);
  }
  const std::vector<std::size_t> suspects = this->suspects();
  // Which of several seem to be off may change with the LED's place.
  const bool same = suspects == suspects_ || (suspects.size() > 1 && suspects_.size() > 1);
  suspects_ = suspects;
  if (same)
    return;
  motion_ = MotionWindow(suspects.size() > 1 ? options_.motion_of_several : options_.motion);
  gravity_.assign(gravity_.size(), {});
}

std::vector<std::size_t> SuspectWatch::suspects() const {
  std::vector<std::size_t> off;
  std::vector<std::size_t> reconnected;
  for (std::size_t i = 0; i < alarms_.size(); ++i) {
    if (alarms_[i].on())
      off.push_back(i);
    if (new_clocks_[i])
      reconnected.push_back(i);
  }
  if (!reconnected.empty())
    return reconnected.size() == 1 ? reconnected : std::vector<std::size_t>();
  return off;
}

}  // namespace wiimote_tracker::continuous
