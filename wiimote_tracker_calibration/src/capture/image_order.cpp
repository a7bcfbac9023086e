#include "capture/image_order.h"

#include <algorithm>
#include <limits>

namespace wiimote_tracker::capture {

namespace {

constexpr double kSetBack = 60.0;  // [s]
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

void ImageOrder::add(Image image, const Take& take) {
  double newest = -kInfinity;
  for (const auto& camera : newest_)
    newest = std::max(newest, camera.second);
  if (image.stamp < newest - kSetBack) {
    flush(take);
    newest_.clear();
    newest = image.stamp;
  }
  newest = std::max(newest, image.stamp);
  double& own = newest_.emplace(image.camera, image.stamp).first->second;
  own = std::max(own, image.stamp);
  const Key key(image.stamp, image.camera);
  waiting_.emplace(key, std::move(image));

  double until = newest;
  for (const auto& entry : newest_) {
    if (entry.second >= newest - kPatience)
      until = std::min(until, entry.second);
  }
  release(until, take);
}

void ImageOrder::flush(const Take& take) {
  release(kInfinity, take);
}

void ImageOrder::release(double until, const Take& take) {
  // Another image with exactly the stamp `until` may still arrive.
  while (!waiting_.empty() && waiting_.begin()->first.first < until) {
    const Image image = std::move(waiting_.begin()->second);
    waiting_.erase(waiting_.begin());
    take(image);
  }
}

}  // namespace wiimote_tracker::capture
