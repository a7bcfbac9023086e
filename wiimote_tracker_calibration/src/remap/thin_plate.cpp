#include "thin_plate.h"

#include <wiimote_tracker_triangulation/remap/model_math.h>

#include <Eigen/LU>

#include <cmath>
#include <limits>

namespace wiimote_tracker::remap {

namespace {

// From interpolating to nearly affine; the unit is half the edge of the support's box.
constexpr double kSmoothings[] = {0.0, 0.001, 0.01, 0.1, 1.0, 10.0};

}  // namespace

std::optional<ThinPlate> fitThinPlate(const std::vector<KnownPoint>& points) {
  const auto n = static_cast<Eigen::Index>(points.size());
  ThinPlate best;
  best.remap.model = Model::kThinPlate;
  for (const KnownPoint& point : points)
    best.remap.support.push_back(point.measured);
  const Frame frame = frameOf(best.remap.support);

  const Eigen::Index size = n + kAffineTerms;
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(size, size);
  Eigen::MatrixXd displacements = Eigen::MatrixXd::Zero(size, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const KnownPoint& point = points[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < n; ++j)
      system(i, j) =
          -(point.measured - points[static_cast<std::size_t>(j)].measured).norm() / frame.scale;
    const auto terms = polynomial(frame.normalized(point.measured));
    system.block<1, kAffineTerms>(i, n) = terms.head<kAffineTerms>().transpose();
    system.block<kAffineTerms, 1>(n, i) = terms.head<kAffineTerms>();
    displacements.row(i) = (point.known - point.measured).transpose();
  }

  double least = std::numeric_limits<double>::infinity();
  for (const double smoothing : kSmoothings) {
    Eigen::MatrixXd smoothed = system;
    smoothed.topLeftCorner(n, n).diagonal().array() += smoothing;
    const Eigen::MatrixXd inverse = smoothed.partialPivLu().inverse();
    const Eigen::MatrixXd weights = inverse * displacements;
    // The leave-one-out error of a point is its weight over the inverse's diagonal (Rippa 1999).
    const Eigen::VectorXd left_out =
        weights.topRows(n).rowwise().norm().array() / inverse.diagonal().head(n).array();
    const double squared = left_out.squaredNorm();
    if (!weights.allFinite() || (inverse.diagonal().head(n).array() <= 0.0).any() ||
        !(squared < least))
      continue;
    least = squared;
    best.left_out_errors.assign(left_out.data(), left_out.data() + n);
    best.remap.parameters.clear();
    for (Eigen::Index row = 0; row < kAffineTerms; ++row) {
      for (Eigen::Index axis = 0; axis < 3; ++axis)
        best.remap.parameters.push_back(weights(n + row, axis));
    }
    for (Eigen::Index row = 0; row < n; ++row) {
      for (Eigen::Index axis = 0; axis < 3; ++axis)
        best.remap.parameters.push_back(-weights(row, axis));
    }
  }
  if (best.left_out_errors.empty())
    return std::nullopt;
  return best;
}

}  // namespace wiimote_tracker::remap
