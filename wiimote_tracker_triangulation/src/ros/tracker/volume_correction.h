#pragma once

#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/remap/correction.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <optional>
#include <string>

namespace wiimote_tracker {

/// The rig's correction of the volume, if it has one, and the reason when it is not used.
class VolumeCorrection {
 public:
  /// @returns whether the correction changed.
  bool take(const geometry::Rig& rig) {
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

  /// Corrects positions, velocities and their covariances, and says which LEDs are remapped.
  /// Outside the measured volume see remap::Correction. Does not allocate.
  void apply(tracking::Snapshot* snapshot) const {
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

  /// "none", the name of the model, or "void".
  std::string state() const {
    if (!remap_)
      return "none";
    return correction_ ? nameOf(remap_->model) : "void";
  }

  /// Why the rig's correction is not used and what to do; empty when it is used or there is none.
  const std::string& problem() const { return problem_; }

 private:
  std::string rig_id_;
  std::optional<remap::Remap> remap_;
  std::optional<remap::Correction> correction_;
  std::string problem_;
};

}  // namespace wiimote_tracker
