#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_CAMERA_CROWD_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_CAMERA_CROWD_H

#include "association/assign_spots.h"

#include <Eigen/Core>
#include <boost/container/static_vector.hpp>

#include <algorithm>

namespace wiimote_tracker::tracking {

/// Whether more lights shine into a camera than it can report, and some of them are unknown. Any
/// spot may then be that of an LED merged with an unknown one.
class CameraCrowd {
 public:
  using Pixels = boost::container::static_vector<Eigen::Vector2d, association::kMaximumSpots>;

  /// @param is_overfull whether the image has as many spots as the camera can report, and none of a
  /// confirmed LED in view. @param unknown its spots of no confirmed LED. A false detection is at
  /// another place in each image; a light moves by less than a distance [px].
  void add(bool is_overfull, const Pixels& unknown, double distance) {
    constexpr double kMemory = 5.0;  // images
    const bool has_light = std::any_of(unknown.begin(), unknown.end(), [&](auto& spot) {
      return std::any_of(unknown_.begin(), unknown_.end(),
                         [&](auto& before) { return (spot - before).norm() < distance; });
    });
    share_ += ((is_overfull && has_light ? 1.0 : 0.0) - share_) / kMemory;
    unknown_ = unknown;
  }

  bool isCrowded() const { return share_ > 0.5; }

 private:
  Pixels unknown_;      // of the last image
  double share_ = 0.0;  // of overfull images that show an unknown light
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_CAMERA_CROWD_H
