#include "wiimote_tracker_triangulation/remap/frame.h"

#include <Eigen/Geometry>

namespace wiimote_tracker::remap {

Frame frameOf(const std::vector<Eigen::Vector3d>& support) {
  Frame frame;
  if (support.empty())
    return frame;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : support)
    box.extend(point);
  frame.middle = box.center();
  const double scale = 0.5 * box.sizes().maxCoeff();
  if (scale > 0.0)
    frame.scale = scale;
  return frame;
}

}  // namespace wiimote_tracker::remap
