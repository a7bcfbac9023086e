#include "wiimote_tracker_triangulation/remap/frame.h"

namespace wiimote_tracker::remap {

Frame frameOf(const std::vector<Eigen::Vector3d>& support) {
  Frame frame;
  if (support.empty())
    return frame;
  Eigen::Vector3d low = support[0];
  Eigen::Vector3d high = support[0];
  for (const Eigen::Vector3d& point : support) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  frame.middle = 0.5 * (low + high);
  const double scale = 0.5 * (high - low).maxCoeff();
  if (scale > 0.0)
    frame.scale = scale;
  return frame;
}

}  // namespace wiimote_tracker::remap
