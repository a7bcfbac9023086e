#pragma once

#include "capture/image.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::capture {

/// What determines a camera: so many images of the LED, of which this share fits to what the other
/// cameras saw, on a path whose thinnest standard deviation is this share of its widest. A person
/// who moves an LED in a plane stays within a few per cent of it.
constexpr std::size_t kLeastSightings = 100;
constexpr double kLeastFitting = 0.5;
constexpr double kThinnestPath = 0.05;

/// Removes spots that do not move (lamps and their reflections): places at which a large share of
/// the images has a spot. @param images of one camera, with their `spots` [px].
template <typename Image>
void removeStillSpots(std::vector<Image>* images) {
  constexpr double kCell = 8.0;  // a lamp's spot stays within this [px]
  // Smallest share of the images in which a lamp is at one place; a moving LED is far below.
  constexpr double kLampShare = 0.25;
  constexpr std::size_t kLeastImages = 100;  // to find lamps in
  using Cell = std::pair<int, int>;
  const auto cellOf = [](const Eigen::Vector2d& spot) {
    return Cell(static_cast<int>(std::floor(spot.x() / kCell)),
                static_cast<int>(std::floor(spot.y() / kCell)));
  };
  std::map<Cell, std::size_t> images_with_spot;
  std::size_t with_spots = 0;
  for (const Image& image : *images) {
    with_spots += image.spots.empty() ? 0 : 1;
    for (const Eigen::Vector2d& spot : image.spots)
      ++images_with_spot[cellOf(spot)];
  }
  if (with_spots < kLeastImages)
    return;
  const auto isStill = [&](const Eigen::Vector2d& spot) {
    // A lamp on the edge of a cell is found in its neighbours.
    const Cell cell = cellOf(spot);
    std::size_t count = 0;
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        const auto found = images_with_spot.find({cell.first + x, cell.second + y});
        count += found == images_with_spot.end() ? 0 : found->second;
      }
    }
    return static_cast<double>(count) > kLampShare * static_cast<double>(with_spots);
  };
  for (Image& image : *images)
    image.spots.erase(std::remove_if(image.spots.begin(), image.spots.end(), isStill),
                      image.spots.end());
}

/// What one camera saw, without spots that do not move.
inline std::vector<Image> imagesOf(const std::string& camera, const std::vector<Image>& images) {
  std::vector<Image> own;
  std::copy_if(images.begin(), images.end(), std::back_inserter(own),
               [&](const Image& image) { return image.camera == camera; });
  removeStillSpots(&own);
  return own;
}

/// The same since its clock runs as it does now: a time offset is that of one epoch.
inline std::vector<Image> latestImagesOf(const std::string& camera,
                                         const std::vector<Image>& images) {
  std::vector<Image> own = imagesOf(camera, images);
  const auto other = std::find_if(own.rbegin(), own.rend(), [&](const Image& image) {
    return image.clock_epoch != own.back().clock_epoch;
  });
  own.erase(own.begin(), other.base());
  return own;
}

}  // namespace wiimote_tracker::capture
