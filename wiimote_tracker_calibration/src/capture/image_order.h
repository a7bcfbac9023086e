#pragma once

#include "capture/image.h"

#include <functional>
#include <map>
#include <string>
#include <utility>

namespace wiimote_tracker::capture {

/// Sorts the images of several cameras by their stamps, so that results do not depend on the order
/// of arrival: live and from a bag, the same images give the same result.
class ImageOrder {
 public:
  /// Longest time for which an image waits for another camera [s].
  static constexpr double kPatience = 0.2;

  using Take = std::function<void(const Image&)>;

  /// Adds one image, and releases in order those that no other can precede: every camera has
  /// delivered a later one, or is more than kPatience behind the newest. A later image is released
  /// at once. An image a minute older than the newest means that the clock was set back: all images
  /// that wait are released, and the order starts again.
  void add(Image image, const Take& take);

  /// Releases all that wait, at the end of a recording.
  void flush(const Take& take);

 private:
  using Key = std::pair<double, std::string>;  // stamp, camera: equal stamps have an order too

  void release(double until, const Take& take);

  std::multimap<Key, Image> waiting_;
  std::map<std::string, double> newest_;  // stamp per camera
};

}  // namespace wiimote_tracker::capture
