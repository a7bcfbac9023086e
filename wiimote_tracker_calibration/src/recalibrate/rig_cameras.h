#pragma once

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <string>

namespace wiimote_tracker::recalibrate {

/// The rig with another camera, the last one, whose calibration is still to come: it and its
/// covariance are zero.
geometry::Rig withCamera(const geometry::Rig& rig, const std::string& name);

/// The rig without a camera. The world, the other cameras and their covariance stay. A correction
/// of the volume stays, but is no longer valid.
/// @throws Error: the rig lacks the camera, or has no more than two.
geometry::Rig withoutCamera(const geometry::Rig& rig, const std::string& name);

/// Which of the others had views in common only through this camera of the rig, and what to do;
/// empty: none.
std::string describeSplit(const geometry::Rig& rig, const std::string& name);

/// Which cameras were moved so far that their masks miss lamps that they covered 3 m away before,
/// and what to do, after "; "; empty: none.
std::string describeOldMasks(const geometry::Rig& before, const geometry::Rig& now);

}  // namespace wiimote_tracker::recalibrate
