#include "wave_path.h"

#include <cmath>
#include <random>

namespace wiimote_tracker::simulation {

WavePath::WavePath(const Eigen::Vector3d& middle,
                   const Eigen::Vector3d& sides,
                   double speed,
                   std::uint32_t seed)
    : middle_(middle), half_sides_(0.5 * sides) {
  std::mt19937 random(seed);
  // Not std::uniform_real_distribution, whose numbers depend on the library.
  const auto between = [&random](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  double mean_square = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    for (int part = 0; part < kParts; ++part) {
      frequency_(axis, part) = part == 0 ? between(0.7, 1.3) : between(1.7, 2.7);
      phase_(axis, part) = between(0.0, 2.0 * M_PI);
      // The mean square of a cosine is 1/2.
      mean_square += 0.5 * std::pow(half_sides_(axis) * kShare[part] * frequency_(axis, part), 2);
    }
  }
  frequency_ *= speed / std::sqrt(mean_square);
}

Eigen::Vector3d WavePath::position(double time) const {
  Eigen::Vector3d position = middle_;
  for (int axis = 0; axis < 3; ++axis) {
    for (int part = 0; part < kParts; ++part)
      position(axis) += half_sides_(axis) * kShare[part] *
                        std::sin(frequency_(axis, part) * time + phase_(axis, part));
  }
  return position;
}

}  // namespace wiimote_tracker::simulation
