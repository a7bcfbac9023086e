#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_GEOMETRY_LEARNT_NOISE_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_GEOMETRY_LEARNT_NOISE_H

#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace wiimote_tracker::geometry {

/// Standard deviation of a pixel coordinate [px], 0.1 to 2, from the residual that the camera was
/// calibrated with, which tells it if many moving spots were used; else nothing. The four still
/// corners of a square do not tell it.
inline std::optional<double> learntNoise(const RigCamera& camera) {
  constexpr std::uint32_t kMany = 100;
  if (camera.inliers < kMany || !std::isfinite(camera.residual_px))
    return std::nullopt;
  return std::clamp(camera.residual_px / std::sqrt(2.0), 0.1, 2.0);
}

/// That of a camera to use [px]: the learnt one, if it may be used and is known, or pixel_stddev.
inline double pixelNoise(const RigCamera& camera, bool use_learnt, double pixel_stddev) {
  return use_learnt ? learntNoise(camera).value_or(pixel_stddev) : pixel_stddev;
}

}  // namespace wiimote_tracker::geometry

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_GEOMETRY_LEARNT_NOISE_H
