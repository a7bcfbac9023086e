#include "geometry/rotation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace wiimote_tracker::geometry {
namespace {

// Written out in scalars: vectorised code may round differently on another machine, and the rig's
// id depends on every bit.
using Wxyz = std::array<double, 4>;

Wxyz withPositiveSign(Wxyz q) {
  const auto first = std::find_if(q.begin(), q.end(), [](double c) { return c != 0.0; });
  const double sign = first != q.end() && *first < 0.0 ? -1.0 : 1.0;
  for (double& c : q)
    c = c == 0.0 ? 0.0 : sign * c;
  return q;
}

// First a component of at least 1/2, so that nothing cancels (Shepperd 1978, in the form of
// Shoemake 1987, which takes w whenever the trace is positive).
Wxyz wxyzFromMatrix(const Eigen::Matrix3d& m) {
  const double trace = m(0, 0) + m(1, 1) + m(2, 2);
  if (trace > 0.0) {
    const double root = std::sqrt(trace + 1.0);
    const double scale = 0.5 / root;
    return withPositiveSign({0.5 * root, (m(2, 1) - m(1, 2)) * scale, (m(0, 2) - m(2, 0)) * scale,
                             (m(1, 0) - m(0, 1)) * scale});
  }
  int i = 0;
  if (m(1, 1) > m(0, 0))
    i = 1;
  if (m(2, 2) > m(i, i))
    i = 2;
  const int j = (i + 1) % 3;
  const int k = (j + 1) % 3;
  const double root = std::sqrt(m(i, i) - m(j, j) - m(k, k) + 1.0);
  const double scale = 0.5 / root;
  Wxyz q{};
  q[0] = (m(k, j) - m(j, k)) * scale;
  q[i + 1] = 0.5 * root;
  q[j + 1] = (m(j, i) + m(i, j)) * scale;
  q[k + 1] = (m(k, i) + m(i, k)) * scale;
  return withPositiveSign(q);
}

Eigen::Matrix3d matrixFromWxyz(const Wxyz& q) {
  const double w = q[0];
  const double x = q[1];
  const double y = q[2];
  const double z = q[3];
  const double s = 2.0 / (w * w + x * x + y * y + z * z);
  Eigen::Matrix3d m;
  m << 1.0 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y),  //
      s * (x * y + w * z), 1.0 - s * (x * x + z * z), s * (y * z - w * x),   //
      s * (x * z - w * y), s * (y * z + w * x), 1.0 - s * (x * x + y * y);
  return m;
}

}  // namespace

Eigen::Matrix3d matrixFromQuaternion(const Eigen::Quaterniond& quaternion) {
  return matrixFromWxyz({quaternion.w(), quaternion.x(), quaternion.y(), quaternion.z()});
}

Eigen::Quaterniond canonicalQuaternion(const Eigen::Matrix3d& rotation) {
  // Quaternion to matrix and back changes the last bits. Repeated, it ends in a cycle, mostly of
  // length one, since there are finitely many doubles. Brent's algorithm finds the cycle; its
  // smallest member is the canonical one.
  const auto step = [](const Wxyz& q) { return wxyzFromMatrix(matrixFromWxyz(q)); };
  Wxyz anchor = wxyzFromMatrix(rotation);
  Wxyz canonical = anchor;
  const bool is_finite =
      std::all_of(anchor.begin(), anchor.end(), [](double c) { return std::isfinite(c); });
  if (is_finite) {
    Wxyz q = step(anchor);
    for (std::size_t steps = 1, limit = 1; q != anchor; ++steps) {
      if (steps == limit) {
        anchor = q;
        limit *= 2;
        steps = 0;
      }
      q = step(q);
    }
    canonical = anchor;
    for (q = step(anchor); q != anchor; q = step(q))
      canonical = std::min(canonical, q);
  }
  return Eigen::Quaterniond(canonical[0], canonical[1], canonical[2], canonical[3]);
}

}  // namespace wiimote_tracker::geometry
