#include "square/expected_error.h"

#include <wiimote_tracker_triangulation/geometry/point_sensitivity.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace wiimote_tracker::square {

double expectedError(const geometry::Rig& rig, const std::vector<Eigen::Vector3d>& points) {
  double sum = 0.0;
  int count = 0;
  for (const Eigen::Vector3d& point : points) {
    const auto by_parameters =
        geometry::hasCovariance(rig)
            ? geometry::pointByParameters(rig, point, geometry::camerasSeeing(rig, point))
            : std::nullopt;
    if (!by_parameters)
      continue;
    ++count;
    sum += (*by_parameters * rig.covariance * by_parameters->transpose()).trace();
  }
  return count > 0 ? std::sqrt(sum / count) : std::numeric_limits<double>::quiet_NaN();
}

std::vector<Eigen::Vector3d> boxOver(const std::array<Eigen::Vector3d, 4>& corners, bool z_up) {
  const double height =
      std::min((corners[1] - corners[0]).norm(), (corners[2] - corners[1]).norm());
  const Eigen::Vector3d up(0.0, 0.0, z_up ? height : -height);
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& corner : corners) {
    points.push_back(corner);
    points.push_back(corner + up);
  }
  points.push_back(0.5 * (corners[0] + corners[2] + up));
  return points;
}

}  // namespace wiimote_tracker::square
