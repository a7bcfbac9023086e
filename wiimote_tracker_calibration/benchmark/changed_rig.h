#ifndef WIIMOTE_TRACKER_CALIBRATION_BENCHMARK_CHANGED_RIG_H
#define WIIMOTE_TRACKER_CALIBRATION_BENCHMARK_CHANGED_RIG_H

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <vector>

namespace wiimote_tracker {

/// RMS error of the points of the volume [m].
double volumeError(const std::vector<geometry::RigCamera>& truth, const geometry::Rig& rig);

/// How far points of the volume that rest seem to move when a rig is replaced, RMS [m].
struct Movement {
  double all = 0.0;
  double apart = 0.0;  ///< Without the similarity by which they move together.
};

Movement movementOf(const std::vector<geometry::RigCamera>& truth,
                    const geometry::Rig& from,
                    const geometry::Rig& to);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_BENCHMARK_CHANGED_RIG_H
