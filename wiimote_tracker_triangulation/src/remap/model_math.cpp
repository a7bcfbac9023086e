#include "wiimote_tracker_triangulation/remap/model_math.h"

#include <Eigen/Geometry>

namespace wiimote_tracker::remap {

namespace {

using Gradient = Eigen::Matrix<double, kTrilinearTerms, 3>;

Gradient polynomialGradient(const Eigen::Vector3d& q) {
  Gradient gradient;
  gradient.topRows<1>().setZero();
  gradient.middleRows<3>(1).setIdentity();
  gradient.row(4) << q.y(), q.x(), 0.0;
  gradient.row(5) << 0.0, q.z(), q.y();
  gradient.row(6) << q.z(), 0.0, q.x();
  gradient.row(7) << q.y() * q.z(), q.z() * q.x(), q.x() * q.y();
  return gradient;
}

using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

Mapped displaced(const Remap& remap, const Frame& frame, const Eigen::Vector3d& point) {
  const Eigen::Vector3d q = frame.normalized(point);
  const int terms = remap.model == Model::kTrilinear ? kTrilinearTerms : kAffineTerms;
  const Eigen::Map<const Rows> coefficients(remap.parameters.data(), terms, 3);
  const auto values = polynomial(q);
  const Gradient gradient = polynomialGradient(q);
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();
  Eigen::Matrix3d derivative = Eigen::Matrix3d::Zero();
  for (int i = 0; i < terms; ++i) {
    displacement += coefficients.row(i).transpose() * values[i];
    derivative += coefficients.row(i).transpose() * gradient.row(i);
  }
  if (remap.model == Model::kThinPlate) {
    const double* row = coefficients.data() + coefficients.size();
    for (const Eigen::Vector3d& center : remap.support) {
      const Eigen::Map<const Eigen::Vector3d> weight(row);
      row += 3;
      const Eigen::Vector3d offset = (point - center) / frame.scale;
      const double distance = offset.norm();
      displacement += weight * distance;
      // A distance has no derivative at its own centre; the mean over all directions is 0.
      if (distance > 0.0)
        derivative += weight * (offset / distance).transpose();
    }
  }
  return {point + displacement, Eigen::Matrix3d::Identity() + derivative / frame.scale};
}

std::optional<Mapped> projected(const Remap& remap,
                                const Frame& frame,
                                const Eigen::Vector3d& point) {
  const Eigen::Vector3d q = frame.normalized(point);
  const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> numerator(
      remap.parameters.data());
  const Eigen::Map<const Eigen::Vector3d> plane(remap.parameters.data() + 12);
  const double denominator = 1.0 + plane.dot(q) / frame.scale;
  // Points near the vanishing plane are mapped towards infinity, points behind it wrap around.
  if (denominator < 0.05)
    return std::nullopt;
  const Eigen::Vector3d offset = (numerator.col(0) + numerator.rightCols<3>() * q) / denominator;
  const Eigen::Matrix3d derivative =
      (numerator.rightCols<3>() - offset * plane.transpose() / frame.scale) / denominator;
  return Mapped{frame.middle + offset, derivative / frame.scale};
}

}  // namespace

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

std::optional<Mapped> evaluate(const Remap& remap,
                               const Frame& frame,
                               const Eigen::Vector3d& point) {
  if (remap.model == Model::kProjective)
    return projected(remap, frame, point);
  return displaced(remap, frame, point);
}

Eigen::Matrix<double, kTrilinearTerms, 1> polynomial(const Eigen::Vector3d& q) {
  Eigen::Matrix<double, kTrilinearTerms, 1> values;
  values << 1.0, q.x(), q.y(), q.z(), q.x() * q.y(), q.y() * q.z(), q.z() * q.x(),
      q.x() * q.y() * q.z();
  return values;
}

}  // namespace wiimote_tracker::remap
