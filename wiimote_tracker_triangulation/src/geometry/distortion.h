#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>

namespace wiimote_tracker::geometry {

using Coefficients = std::array<double, 5>;

/// Whether a polynomial of degree 4 is positive on [0, 1], from its Bernstein coefficients: it lies
/// between the least and the largest. The interval is halved where that does not decide.
inline bool isPositive(const std::array<double, 5>& b, int halvings) {
  if (!(b.front() > 0.0 && b.back() > 0.0))
    return false;
  if (*std::min_element(b.begin(), b.end()) > 0.0)
    return true;
  if (halvings == 0)
    return false;  // zero within rounding
  std::array<double, 5> left, right = b;
  for (std::size_t i = 0; i < b.size(); ++i) {
    left[i] = right[0];
    for (std::size_t j = 0; j + 1 < b.size() - i; ++j)
      right[j] = 0.5 * (right[j] + right[j + 1]);
  }
  return isPositive(left, halvings - 1) && isPositive(right, halvings - 1);
}

/// Whether x (1 + k1 x^2 + k2 x^4 + k3 x^6 + k4 x^8) grows from x = 0 up to x^2 = s, where lens
/// models fold: 1 + 3 k1 t + 5 k2 t^2 + 7 k3 t^3 + 9 k4 t^4 > 0 on [0, s].
inline bool growsUpTo(const std::array<double, 4>& k, double s) {
  const double a = 3.0 * k[0] * s;
  const double b = 5.0 * k[1] * s * s;
  const double c = 7.0 * k[2] * s * s * s;
  const double d = 9.0 * k[3] * s * s * s * s;
  constexpr int kHalvings = 20;
  return isPositive({1.0, 1.0 + a / 4.0, 1.0 + a / 2.0 + b / 6.0,
                     1.0 + 3.0 * a / 4.0 + b / 2.0 + c / 4.0, 1.0 + a + b + c + d},
                    kHalvings);
}

/// The formulas of a lens model, on the image plane of depth 1. None of them allocates.
struct LensFormulas {
  const char* name;
  const char* coefficient_names;
  std::size_t coefficient_count;

  /// The distorted point of an undistorted one, n. `jacobian`: d result / d n, when it is not null.
  Eigen::Vector2d (*distort)(const Coefficients& k,
                             const Eigen::Vector2d& n,
                             Eigen::Matrix2d* jacobian);

  /// The undistorted point of a distorted one if all coefficients are 0.
  Eigen::Vector2d (*undistortIdeal)(const Eigen::Vector2d& distorted);

  /// @param jacobian of distort() at n, perhaps with rows scaled by positive numbers.
  bool (*isBeforeFold)(const Coefficients& k,
                       const Eigen::Vector2d& n,
                       const Eigen::Matrix2d& jacobian);
};

namespace plumb_bob {
extern const LensFormulas kFormulas;
}
namespace equidistant {
extern const LensFormulas kFormulas;
}

}  // namespace wiimote_tracker::geometry
