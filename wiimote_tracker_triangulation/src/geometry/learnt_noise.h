#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_GEOMETRY_LEARNT_NOISE_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_GEOMETRY_LEARNT_NOISE_H

#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace wiimote_tracker::geometry {

/// Standard deviation of a camera's pixel coordinates [px]: if `use_learnt`, that of the residual
/// with which it was calibrated, within 0.1 and 2. Many moving spots tell it; the four still
/// corners of a square do not. Else pixel_stddev.
inline double pixelNoise(const RigCamera& camera, bool use_learnt, double pixel_stddev) {
  constexpr std::uint32_t kMany = 100;
  if (!use_learnt || camera.inliers < kMany || !std::isfinite(camera.residual_px))
    return pixel_stddev;
  return std::clamp(camera.residual_px / std::sqrt(2.0), 0.1, 2.0);
}

}  // namespace wiimote_tracker::geometry

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_GEOMETRY_LEARNT_NOISE_H
