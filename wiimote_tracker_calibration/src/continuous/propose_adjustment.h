#ifndef WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_PROPOSE_ADJUSTMENT_H
#define WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_PROPOSE_ADJUSTMENT_H

#include "capture/image.h"
#include "continuous/proposal.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <optional>
#include <vector>

namespace wiimote_tracker::continuous {

/// A proposal whose rig says in its verdict what has changed, and when that was checked.
/// @param before the rig in use. @param checked the images that the rig was checked with.
Proposal dated(Proposal proposal,
               const geometry::Rig& before,
               const std::vector<capture::Image>& checked);

/// Proposes a rig that adjustRig() made, if it explains later images better than the rig before:
/// with the poses of that one where the adjusted clocks explain nearly as much.
/// @returns nothing when it explains too little more, when too few places were seen, when a camera
/// does not fit the others or reconnected since, or when poses differ by more than drift.
std::optional<Proposal> proposeAdjustment(const geometry::Rig& before,
                                          const geometry::Rig& adjusted,
                                          const std::vector<capture::Image>& later);

/// The angle between the attitudes of a camera [rad].
double turnOf(const geometry::RigCamera& a, const geometry::RigCamera& b);

}  // namespace wiimote_tracker::continuous

#endif  // WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_PROPOSE_ADJUSTMENT_H
