#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_START_POSES_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_START_POSES_H

#include "wiimote_tracker_calibration/wave/recording.h"
#include "wiimote_tracker_calibration/wave/solve_wave.h"

#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <vector>

namespace wiimote_tracker::wave {

/// Rough poses of the cameras (centimetres): with a square in its world, else up to scale.
struct StartPoses {
  std::vector<geometry::Camera> cameras;  ///< In the order of the recording.
  bool z_up = true;                       ///< As in SquareLayout::corners().
  bool from_square = false;               ///< Not from the wave alone.
};

/// From the square where two cameras or more saw all of it; the other cameras from common points
/// of the wave by resection. Without such a square from the wave alone (essential matrix), then
/// aligned with the corners that two cameras saw. A start from the wave alone uses a random sample
/// of points and may be wrong; each `attempt` uses other points.
/// @param recording without spots that stay in one place (capture::removeStillSpots()).
/// @throws WaveError, square::SquareError.
StartPoses startPoses(const Recording& recording, const WaveOptions& options, int attempt);

}  // namespace wiimote_tracker::wave

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_START_POSES_H
