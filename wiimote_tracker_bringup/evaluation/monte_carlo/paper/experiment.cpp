#include "experiment.h"

#include <cmath>

namespace wiimote_tracker::monte_carlo {

std::vector<Eigen::Vector3d> tenPoints() {
  std::vector<Eigen::Vector3d> points;
  for (const double height : {0.0, kSide}) {
    points.emplace_back(0.0, 0.0, height);
    points.emplace_back(kSide, 0.0, height);
    points.emplace_back(kSide, kSide, height);
    points.emplace_back(0.0, kSide, height);
  }
  points.emplace_back(1.25, 1.25, 0.0);
  points.emplace_back(1.25, 1.25, 1.5);
  return points;
}

std::array<Eigen::Vector3d, 3> circleCenters() {
  return {Eigen::Vector3d(1.0, 1.0, 0.23), Eigen::Vector3d(1.5, 1.5, 0.23),
          Eigen::Vector3d(1.25, 1.25, 0.95)};
}

Eigen::Vector3d onCircle(std::size_t circle, double angle) {
  return circleCenters()[circle] +
         kCircleRadius * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
}

Eigen::Vector3d placed(const Eigen::Vector3d& point, std::mt19937_64& random) {
  const bool on_floor = point.z() == 0.0;
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (;;) {
    const double x = uniform(random);
    const double y = uniform(random);
    const Eigen::Vector3d offset(x, y, on_floor ? 0.0 : uniform(random));
    if (offset.squaredNorm() <= 1.0)
      return point + (on_floor ? kFloorPlacement : kAirPlacement) * offset;
  }
}

}  // namespace wiimote_tracker::monte_carlo
