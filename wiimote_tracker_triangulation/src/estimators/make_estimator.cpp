#include "wiimote_tracker_triangulation/estimators/make_estimator.h"

#include "wiimote_tracker_triangulation/tracking/tracker.h"

namespace wiimote_tracker::estimators {

std::unique_ptr<tracking::Estimator> makeEstimator(const geometry::Rig& rig,
                                                   const EstimatorOptions& options) {
  if (options.mode == Mode::kInstant)
    return std::make_unique<fusion::InstantFuser>(rig, options.instant);
  return std::make_unique<tracking::Tracker>(rig, options.tracks);
}

}  // namespace wiimote_tracker::estimators
