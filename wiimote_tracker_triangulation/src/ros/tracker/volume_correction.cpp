#include "volume_correction.h"

#include "wiimote_tracker_triangulation/geometry/error.h"

namespace wiimote_tracker {

bool VolumeCorrection::take(const geometry::Rig& rig) {
  const std::string rig_id = rig.id();
  if (rig_id == rig_id_ && rig.remap == remap_)
    return false;
  const bool had_none = !remap_;
  rig_id_ = rig_id;
  remap_ = rig.remap;
  correction_.reset();
  problem_.clear();
  try {
    if (remap_)
      correction_.emplace(*remap_, rig_id);
  } catch (const Error& e) {
    problem_ = e.what();
  }
  return remap_ || !had_none;
}

void VolumeCorrection::apply(tracking::Snapshot* snapshot) const {
  for (tracking::TrackedLed& led : snapshot->leds) {
    led.remapped = false;
    const auto corrected =
        correction_ ? correction_->apply(led.position, led.position_covariance) : std::nullopt;
    if (!corrected)
      continue;
    led.remapped = corrected->inside;
    led.position = corrected->position;
    led.position_covariance = corrected->covariance;
    if (led.velocity) {
      const Eigen::Matrix3d& J = corrected->jacobian;
      led.velocity = Eigen::Vector3d(J * *led.velocity);
      led.velocity_covariance = J * led.velocity_covariance.eval() * J.transpose();
    }
  }
}

std::string VolumeCorrection::state() const {
  if (!remap_)
    return "none";
  return correction_ ? nameOf(remap_->model) : "void";
}

}  // namespace wiimote_tracker
