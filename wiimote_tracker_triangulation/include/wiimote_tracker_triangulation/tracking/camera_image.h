#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace wiimote_tracker::tracking {

/// One spot (blob) of an image.
struct Spot {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< Distorted [px].
  int slot = -1;                                    ///< Index in the report; -1: unknown.
};

/// How an image fits LEDs that other cameras see.
struct LedFit {
  std::size_t shown = 0;      ///< LEDs that have a spot in the image.
  std::size_t missing = 0;    ///< Those without, which two others see, or the only other camera.
  std::size_t explained = 0;  ///< Of the missing, those that the calibration's errors explain.
};

/// An image as it comes from a camera; fields as in IrBlobArray.msg.
struct CameraImage {
  double stamp = 0.0;    ///< Middle of the exposure, without the rig's time offset [s].
  double arrival = 0.0;  ///< When it reached the computer [s].
  double stamp_stddev = std::numeric_limits<double>::quiet_NaN();  ///< [s, >= 0]; NaN: unknown.
  std::uint32_t clock_epoch = 0;
  std::size_t maximum_spots = 4;  ///< With so many spots, more LEDs may be visible.
  std::vector<Spot> spots;
  LedFit bodies;  ///< Each body counts as one LED; its spots are not among `spots`.
};

}  // namespace wiimote_tracker::tracking
