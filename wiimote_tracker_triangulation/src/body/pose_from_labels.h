#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_BODY_POSE_FROM_LABELS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_BODY_POSE_FROM_LABELS_H

#include "wiimote_tracker_triangulation/body/body_tracker.h"

#include <optional>
#include <vector>

namespace wiimote_tracker::body {

/// The pose of a body from labelled points. Nothing when fewer than three of its LEDs are among
/// them, or they lie on a line or do not agree with the constellation.
std::optional<BodyPose> poseFromLabels(const Constellation& constellation,
                                       const std::vector<LabelledPoint>& points);

}  // namespace wiimote_tracker::body

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_BODY_POSE_FROM_LABELS_H
