#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_STATE_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_STATE_H

#include "trajectory.h"

#include "wiimote_tracker_calibration/square/square_layout.h"

#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace wiimote_tracker::wave {

/// Everything that is estimated.
struct State {
  std::vector<geometry::Camera> cameras;
  std::vector<double> offsets;  ///< exposure time = stamp + offset [s].
  Trajectory trajectory;
  square::Corners corners{};  ///< Where the LED was put [m].
  double wand_length = 0.0;   ///< [m]
};

/// A spot that is taken for an LED.
struct Match {
  std::size_t camera;
  Eigen::Index led;
  double stamp;  ///< [s]
  Eigen::Vector2d pixel;
  Eigen::Matrix2d whitening;  ///< Of the pixel error [1/px].
};

}  // namespace wiimote_tracker::wave

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_STATE_H
