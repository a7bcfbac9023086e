#include "volume_correction.h"

#include "wiimote_tracker_triangulation/remap/error.h"

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
  } catch (const remap::RemapError& e) {
    problem_ = e.what();
  }
  return remap_ || !had_none;
}

bool VolumeCorrection::apply(geometry::TriangulatedPoint* point) const {
  if (!correction_)
    return false;
  const auto corrected = correction_->apply(point->position, point->covariance);
  if (!corrected)
    return false;
  point->position = corrected->position;
  point->covariance = corrected->covariance;
  return corrected->inside;
}

std::string VolumeCorrection::state() const {
  if (!remap_)
    return "none";
  return correction_ ? nameOf(remap_->model) : "void";
}

}  // namespace wiimote_tracker
