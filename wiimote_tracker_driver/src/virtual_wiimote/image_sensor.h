#ifndef WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_IMAGE_SENSOR_H
#define WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_IMAGE_SENSOR_H

#include "wiimote_tracker_driver/virtual_wiimote/device.h"

#include <array>
#include <cstdint>
#include <vector>

namespace wiimote_tracker::virtual_wiimote {

/// A bright spot as the camera measures it.
struct Blob {
  int x = 0;  ///< 0..1023
  int y = 0;  ///< 0..767, up
  int size = 0;
  int intensity = 0;         ///< 0..255
  std::array<int, 4> box{};  ///< x and y from, x and y to [cells of 8 px].
};

/// Irradiance, in the unit of Light::brightness, below which nothing is seen, for the registers
/// GAINLIMIT (the highest gain: the lower the value, the higher) and MINSIZE (of a blob).
double brightnessThreshold(std::uint8_t gain_limit, std::uint8_t minimum_size);

/// What a camera with that threshold makes of the lights in its image: lights whose images touch
/// are one blob, those too dim are none, and of the others it measures the four brightest, in the
/// order of their brightness.
std::vector<Blob> findBlobs(const std::vector<Light>& lights, double threshold);

}  // namespace wiimote_tracker::virtual_wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_IMAGE_SENSOR_H
