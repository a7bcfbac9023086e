#ifndef WIIMOTE_TRACKER_CALIBRATION_CAPTURE_IMAGE_ORDER_H
#define WIIMOTE_TRACKER_CALIBRATION_CAPTURE_IMAGE_ORDER_H

#include "wiimote_tracker_calibration/capture/image.h"

#include <functional>
#include <map>
#include <string>
#include <utility>

namespace wiimote_tracker::capture {

/// Brings the images of several cameras into the order of their stamps, so that what is made of
/// them does not depend on the order in which they came: live and from a bag, the same images give
/// the same result.
class ImageOrder {
 public:
  /// Longest time by which an image waits for another camera [s].
  static constexpr double kPatience = 0.2;

  using Take = std::function<void(const Image&)>;

  /// Takes one image, and hands on, in order, those that no camera can precede any more: every
  /// camera has delivered a later one, or is more than kPatience behind the newest. An image that
  /// comes too late for that is handed on at once. Images a minute older than the newest are of a
  /// clock that was set back: those that wait are handed on, and the order begins anew.
  void add(Image image, const Take& take);

 private:
  using Key = std::pair<double, std::string>;  // stamp, camera: equal stamps have an order too

  void release(double until, const Take& take);

  std::multimap<Key, Image> waiting_;
  std::map<std::string, double> newest_;  // stamp per camera
};

}  // namespace wiimote_tracker::capture

#endif  // WIIMOTE_TRACKER_CALIBRATION_CAPTURE_IMAGE_ORDER_H
