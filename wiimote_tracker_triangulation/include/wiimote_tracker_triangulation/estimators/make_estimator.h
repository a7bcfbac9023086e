#ifndef WIIMOTE_TRACKER_TRIANGULATION_ESTIMATORS_MAKE_ESTIMATOR_H
#define WIIMOTE_TRACKER_TRIANGULATION_ESTIMATORS_MAKE_ESTIMATOR_H

#include "wiimote_tracker_triangulation/fusion/instant_fuser.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/estimator.h"
#include "wiimote_tracker_triangulation/tracking/tracker.h"

#include <memory>

namespace wiimote_tracker::estimators {

enum class Mode {
  kTracks,   ///< tracking::Tracker
  kInstant,  ///< fusion::InstantFuser, the paper's method
};

struct EstimatorOptions {
  Mode mode = Mode::kTracks;
  tracking::TrackerOptions tracks;      ///< Of kTracks.
  fusion::InstantFuserOptions instant;  ///< Of kInstant.
};

/// @throws geometry::InvalidRigError (see Rig::check).
inline std::unique_ptr<tracking::Estimator> makeEstimator(const geometry::Rig& rig,
                                                          const EstimatorOptions& options) {
  if (options.mode == Mode::kInstant)
    return std::make_unique<fusion::InstantFuser>(rig, options.instant);
  return std::make_unique<tracking::Tracker>(rig, options.tracks);
}

}  // namespace wiimote_tracker::estimators

#endif  // WIIMOTE_TRACKER_TRIANGULATION_ESTIMATORS_MAKE_ESTIMATOR_H
