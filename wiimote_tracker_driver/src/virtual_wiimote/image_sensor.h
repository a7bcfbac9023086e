#pragma once

#include "wiimote_tracker_driver/virtual_wiimote/device.h"

#include <array>
#include <cstdint>
#include <vector>

namespace wiimote_tracker::virtual_wiimote {

/// A spot as measured by the camera.
struct Blob {
  int x = 0;  ///< 0..1023
  int y = 0;  ///< 0..767, up
  int size = 0;
  int intensity = 0;         ///< 0..255
  std::array<int, 4> box{};  ///< x and y minimum, x and y maximum [cells of 8 px].
};

/// Threshold of detection in the unit of Light::brightness, for the registers GAINLIMIT (lower
/// values allow a higher gain) and MINSIZE (least size of a blob).
double brightnessThreshold(std::uint8_t gain_limit, std::uint8_t minimum_size);

/// Simulates the camera's detection: lights whose images touch merge, lights below the threshold
/// vanish, and the four brightest are measured, in the order of their brightness.
std::vector<Blob> findBlobs(const std::vector<Light>& lights, double threshold);

}  // namespace wiimote_tracker::virtual_wiimote
