#pragma once

#include "wiimote_tracker_triangulation/fusion/instant_fuser.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/estimator.h"
#include "wiimote_tracker_triangulation/tracking/tracker.h"

#include <memory>

namespace wiimote_tracker::estimators {

/// The parameter `mode`.
enum class TrackerMode {
  kTracks,   ///< tracking::Tracker
  kInstant,  ///< fusion::InstantFuser, the paper's method
};

struct EstimatorOptions {
  TrackerMode tracker_mode = TrackerMode::kTracks;
  tracking::TrackerOptions tracks;      ///< Of kTracks.
  fusion::InstantFuserOptions instant;  ///< Of kInstant.
};

/// @throws geometry::InvalidRigError (see Rig::check).
inline std::unique_ptr<tracking::Estimator> makeEstimator(const geometry::Rig& rig,
                                                          const EstimatorOptions& options) {
  if (options.tracker_mode == TrackerMode::kInstant)
    return std::make_unique<fusion::InstantFuser>(rig, options.instant);
  return std::make_unique<tracking::Tracker>(rig, options.tracks);
}

}  // namespace wiimote_tracker::estimators
