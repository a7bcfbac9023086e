#include "image_record.h"

#include <algorithm>
#include <utility>

namespace wiimote_tracker::real_kernel {
namespace {

// Frames between sampling and publication: more than the pauses of a stream that recovers.
constexpr long kOldest = 20;

std::string textOf(const protocol::DataReport& image) {
  std::string text;
  for (const protocol::IrSpot& spot : image.spots) {
    if (spot.seen)
      text += " (" + std::to_string(spot.x) + ", " + std::to_string(spot.y) + ", size " +
              std::to_string(spot.size) + ")";
  }
  return text;
}

}  // namespace

void ImageTotals::add(const std::string& problem) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++images_;
  if (problem.empty())
    return;
  if (wrong_++ == 0)
    first_problem_ = problem;
}

bool ImageTotals::right() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return wrong_ == 0;
}

std::string ImageTotals::text() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::to_string(images_) + " images, " + std::to_string(wrong_) + " wrong" +
         (wrong_ == 0 ? "" : "; the first: " + first_problem_);
}

bool ImageRecord::showsLights(const protocol::DataReport& image) {
  return std::any_of(image.spots.begin(), image.spots.end(),
                     [](const protocol::IrSpot& spot) { return spot.seen; });
}

std::string ImageRecord::problemOf(const protocol::DataReport& image) {
  const long newest = scene_.frame();
  const std::optional<long> frame = scene_.frameOf(image);
  if (!frame)
    return "lights that were not there:" + textOf(image);
  const long before = std::exchange(last_frame_, *frame);
  if (*frame >= std::max(before, newest - kOldest))
    return "";
  return "frame " + std::to_string(*frame) + " of " + std::to_string(newest) + " after " +
         std::to_string(before);
}

}  // namespace wiimote_tracker::real_kernel
