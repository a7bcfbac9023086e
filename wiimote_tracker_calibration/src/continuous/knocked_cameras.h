#pragma once

#include "continuous/suspect_watch.h"
#include "recalibrate/recalibrate_camera.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::continuous {

/// Cameras of a rig, as it counts them, ascending.
using Cameras = std::vector<std::size_t>;

/// The images of all cameras but these.
std::vector<capture::Image> without(const geometry::Rig& rig,
                                    const Cameras& cameras,
                                    const std::vector<capture::Image>& images);

/// Cameras that were solved against the others.
struct SolvedCameras {
  geometry::Rig rig;    ///< Its covariance includes the drift of the others. Without solved_at.
  std::string message;  ///< How each has changed, and how well its images fit then.
};

/// Solves each of these cameras against those that are not named, which hold the world. All must
/// have contradicted these, unless they reconnected or turned; later images must fit all cameras.
/// @returns nothing when more motion is needed, or what a camera sees is another light.
std::optional<SolvedCameras> solveAgainstOthers(const geometry::Rig& rig,
                                                const Cameras& cameras,
                                                const Evidence& evidence,
                                                const recalibrate::Options& options);

/// The pairs of cameras without which the others agree best, as far as those were not tilted. Where
/// two cameras of four were knocked this is one pair, after enough motion; where two were moved as
/// one, or see the same other light, these two or the others.
std::vector<Cameras> pairsToSolve(const geometry::Rig& rig, const Evidence& evidence);

/// One sentence, if each of two pairs agrees in itself but not with the other; else empty.
std::string contradictionOf(const geometry::Rig& rig, const std::vector<Cameras>& pairs);

}  // namespace wiimote_tracker::continuous
