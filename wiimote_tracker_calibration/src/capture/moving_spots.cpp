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

void append(double time, const Image& image, std::vector<Spot>* spots) {
  if (image.spots.size() == 1 && (spots->empty() || time > spots->back().time))
    spots->push_back({time, image.spots.front()});
}

std::optional<fusion::Bracket<Spot>> bracket(const std::vector<Spot>& spots, double time) {
  const auto after =
      std::lower_bound(spots.begin(), spots.end(), time,
                       [](const Spot& spot, double value) { return spot.time < value; });
  if (after == spots.end() || after == spots.begin())
    return std::nullopt;
  const fusion::Bracket<Spot> found{&*(after - 1), &*after};
  return found.gap() > kLongestGap ? std::nullopt : std::make_optional(found);
}

}  // namespace wiimote_tracker::capture
