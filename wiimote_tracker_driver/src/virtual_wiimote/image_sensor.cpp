#include "image_sensor.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::virtual_wiimote {
namespace {

constexpr std::size_t kMaximumBlobs = 4;

// The image has 128 x 96 cells of 8 px.
constexpr double kCell = 8.0;
constexpr int kColumns = 128;
constexpr int kRows = 96;

// The console's middle level: GAINLIMIT and MINSIZE.
constexpr double kMiddleGainLimit = 0x63;
constexpr double kMiddleMinimumSize = 0x03;
// Distance at which a sensor bar is just seen at that level [m]. Chosen: people play from 1 to 5 m.
constexpr double kMiddleReach = 6.0;
constexpr double kMiddleThreshold = 1.0 / (kMiddleReach * kMiddleReach);

// Size at the middle level: 2.37 z^-0.778 for a sensor bar at z metres, fitted by Dolphin's authors
// to a real remote; here z is the distance of a sensor bar of equal brightness.
constexpr double kSizeFactor = 2.37;
constexpr double kSizeExponent = 0.778 / 2.0;
// They saw about half a unit between the console's least and most sensitive levels, whose
// thresholds have a ratio of 13.6 here.
constexpr double kSizePerLogSensitivity = 0.5 / 2.61;
constexpr double kLargestSize = 15.0;

// Irradiance, in thresholds, above which positions are resolved to a pixel, and at which the
// intensity is half its maximum. Both chosen.
constexpr double kFineFrom = 8.0;
constexpr double kHalfIntensity = 8.0;
constexpr double kLargestIntensity = 255.0;

/// One light, or several merged ones, before measurement.
struct Spot {
  double x;
  double y;
  double size;
  double brightness;
};

double sizeOf(double brightness, double threshold) {
  const double size = kSizeFactor * std::pow(brightness, kSizeExponent) +
                      kSizePerLogSensitivity * std::log(kMiddleThreshold / threshold);
  return std::clamp(size, 1.0, kLargestSize);
}

bool inImage(const Light& light) {
  return light.x > -0.5 && light.x < 1023.5 && light.y > -0.5 && light.y < 767.5;
}

/// Radius of a spot [px].
double radius(double size) {
  return 0.5 * kCell * size;
}

bool touch(const Spot& a, const Spot& b) {
  return std::hypot(a.x - b.x, a.y - b.y) < radius(a.size) + radius(b.size);
}

Spot together(const Spot& a, const Spot& b) {
  const double distance = std::hypot(a.x - b.x, a.y - b.y);
  const double brightness = a.brightness + b.brightness;
  Spot spot;
  spot.x = (a.brightness * a.x + b.brightness * b.x) / brightness;
  spot.y = (a.brightness * a.y + b.brightness * b.y) / brightness;
  // The longest extent of both.
  spot.size = std::max({a.size, b.size, 0.5 * (a.size + b.size) + distance / kCell});
  spot.brightness = brightness;
  return spot;
}

/// Merges spots until no two touch.
void merge(std::vector<Spot>& spots) {
  for (std::size_t i = 0; i < spots.size();) {
    const auto other = std::find_if(spots.begin() + static_cast<std::ptrdiff_t>(i) + 1, spots.end(),
                                    [&](const Spot& spot) { return touch(spots[i], spot); });
    if (other == spots.end()) {
      ++i;
      continue;
    }
    spots[i] = together(spots[i], *other);
    spots.erase(other);
    i = 0;  // it may now touch an earlier one
  }
}

/// Rounds a coordinate to a grid of `step` px, aligned with the cells.
int quantised(double coordinate, double step, int limit) {
  const double pixel = (std::floor((coordinate + 0.5) / step) + 0.5) * step - 0.5;
  return std::clamp(static_cast<int>(std::lround(pixel)), 0, limit - 1);
}

int cell(double coordinate, int limit) {
  return std::clamp(static_cast<int>(std::floor(coordinate / kCell)), 0, limit - 1);
}

Blob measure(const Spot& spot, double threshold) {
  const double strength = spot.brightness / threshold;
  // A weak spot covers one or two cells, which limits its resolution.
  const double step = std::clamp(kFineFrom / strength, 1.0, kCell);
  Blob blob;
  blob.x = quantised(spot.x, step, 1024);
  blob.y = quantised(spot.y, step, 768);
  blob.size = static_cast<int>(std::lround(std::clamp(spot.size, 0.0, kLargestSize)));
  blob.intensity =
      static_cast<int>(std::lround(kLargestIntensity * strength / (strength + kHalfIntensity)));
  const double reach = radius(blob.size);
  blob.box = {cell(blob.x - reach, kColumns), cell(blob.y - reach, kRows),
              cell(blob.x + reach, kColumns), cell(blob.y + reach, kRows)};
  return blob;
}

}  // namespace

double brightnessThreshold(std::uint8_t gain_limit, std::uint8_t minimum_size) {
  const double smallest = std::max<double>(1.0, minimum_size);
  return kMiddleThreshold * (gain_limit / kMiddleGainLimit) * (smallest / kMiddleMinimumSize);
}

std::vector<Blob> findBlobs(const std::vector<Light>& lights, double threshold) {
  std::vector<Spot> spots;
  for (const Light& light : lights) {
    if (inImage(light) && light.brightness > 0.0 && std::isfinite(light.brightness))
      spots.push_back({light.x, light.y, light.size.value_or(sizeOf(light.brightness, threshold)),
                       light.brightness});
  }
  merge(spots);
  std::stable_sort(spots.begin(), spots.end(),
                   [](const Spot& a, const Spot& b) { return a.brightness > b.brightness; });
  std::vector<Blob> blobs;
  for (const Spot& spot : spots) {
    if (spot.brightness >= threshold && blobs.size() < kMaximumBlobs)
      blobs.push_back(measure(spot, threshold));
  }
  return blobs;
}

}  // namespace wiimote_tracker::virtual_wiimote
