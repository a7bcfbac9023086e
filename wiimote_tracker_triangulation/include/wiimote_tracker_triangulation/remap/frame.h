#ifndef WIIMOTE_TRACKER_TRIANGULATION_REMAP_FRAME_H
#define WIIMOTE_TRACKER_TRIANGULATION_REMAP_FRAME_H

#include <Eigen/Core>

#include <vector>

namespace wiimote_tracker::remap {

/// Coordinates of the models: centre and half the longest edge of the bounding box of the support
/// [m].
struct Frame {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double scale = 1.0;

  Eigen::Vector3d normalized(const Eigen::Vector3d& point) const {
    return (point - middle) / scale;
  }
};

Frame frameOf(const std::vector<Eigen::Vector3d>& support);

}  // namespace wiimote_tracker::remap

#endif  // WIIMOTE_TRACKER_TRIANGULATION_REMAP_FRAME_H
