#ifndef WIIMOTE_TRACKER_CALIBRATION_WORKFLOW_TAPED_LENGTHS_H
#define WIIMOTE_TRACKER_CALIBRATION_WORKFLOW_TAPED_LENGTHS_H

#include "workflow/captured.h"
#include "workflow/reply.h"

#include <cstddef>

namespace wiimote_tracker::workflow {

/// Takes a length between two captured corners, in place of an earlier one between them; a length
/// of 0 drops that. Refused when the sides and the errors of the placement do not allow it.
/// @param placement of the LED on a corner: standard deviation per axis [m].
Reply takeLength(const square::TapedLength& taped, double placement, Captured* captured);

/// Drops the lengths to a corner, where the LED does not lie any more as it lay.
void dropLengthsTo(std::size_t corner, Captured* captured);

/// Takes where cameras saw the LED on a known place.
Reply takePlace(const square::KnownPlace& known,
                const capture::CapturedCorner& seen,
                Captured* captured);

/// Drops the last known place. @returns false when there is none.
bool dropLastPlace(Captured* captured);

}  // namespace wiimote_tracker::workflow

#endif  // WIIMOTE_TRACKER_CALIBRATION_WORKFLOW_TAPED_LENGTHS_H
