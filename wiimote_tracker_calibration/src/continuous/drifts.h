#ifndef WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_DRIFTS_H
#define WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_DRIFTS_H

#include "capture/image.h"
#include "health/drift_watch.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::continuous {

/// Per camera of the rig; nothing: it was not judged.
using Drifts = std::vector<std::optional<health::Drift>>;

/// How far each camera of the rig is off in these images, by the health watch's default limit.
Drifts driftsOf(const geometry::Rig& rig, const std::vector<capture::Image>& images);

/// Whether so many cameras at least were judged, and none contradicts the others.
bool allFit(const Drifts& drifts, std::ptrdiff_t cameras = 3);

}  // namespace wiimote_tracker::continuous

#endif  // WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_DRIFTS_H
