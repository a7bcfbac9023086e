#include "capture/moving_spots.h"

#include <iterator>

namespace wiimote_tracker::capture {

std::vector<Image> imagesOf(const std::string& camera, const std::vector<Image>& images) {
  std::vector<Image> own;
  std::copy_if(images.begin(), images.end(), std::back_inserter(own),
               [&](const Image& image) { return image.camera == camera; });
  removeStillSpots(&own);
  return own;
}

std::vector<Image> latestImagesOf(const std::string& camera, const std::vector<Image>& images) {
  std::vector<Image> own = imagesOf(camera, images);
  const auto other = std::find_if(own.rbegin(), own.rend(), [&](const Image& image) {
    return image.clock_epoch != own.back().clock_epoch;
  });
  own.erase(own.begin(), other.base());
  return own;
}

}  // namespace wiimote_tracker::capture
