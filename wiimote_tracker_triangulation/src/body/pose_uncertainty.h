#pragma once

#include "body/body_estimate.h"
#include "body/constellation.h"
#include "wiimote_tracker_triangulation/body/pose_state.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <optional>

namespace wiimote_tracker::body {

/// Covariance of a body's pose due to the calibration's errors: D C D^T, with the joint covariance
/// C of the rig's parameters and D = -(J^T J)^-1 J^T A, the derivatives of the maximum-likelihood
/// pose (solvePose) by them; J and A: of the pixels by pose and parameters. See
/// geometry::CalibrationUncertainty, which is the same for a point: the error does not average out
/// over images.
///
/// The pixels are those of the LEDs and cameras in BodyEstimate::leds. Where these do not determine
/// the pose, or there are none, they are those of all LEDs in the cameras' fields of view.
/// @param estimate its covariance is not used.
/// @returns position [m^2], rotation about the world axes [rad^2]. Nothing when the rig has no
/// covariance, or no pixels determine the pose. Does not allocate.
std::optional<PoseCovariance> calibrationCovariance(const geometry::Rig& rig,
                                                    const Constellation& constellation,
                                                    const BodyEstimate& estimate);

}  // namespace wiimote_tracker::body
