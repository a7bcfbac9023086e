#include "fit_model.h"

#include <wiimote_tracker_triangulation/remap/model_math.h>

#include <Eigen/LU>
#include <Eigen/QR>

#include <cmath>
#include <limits>

namespace wiimote_tracker::remap {

namespace {

// A pivot below this share of the largest means that the points do not determine a parameter.
constexpr double kLeastPivot = 1e-3;
// From interpolating to nearly affine; the unit is half the edge of the support's box.
constexpr double kSmoothings[] = {0.0, 0.001, 0.01, 0.1, 1.0, 10.0};

Remap emptyRemap(Model model, const std::vector<KnownPoint>& points) {
  Remap remap;
  remap.model = model;
  for (const KnownPoint& point : points)
    remap.support.push_back(point.measured);
  return remap;
}

/// Appends a matrix to the parameters, row by row.
void append(const Eigen::MatrixX3d& rows, std::vector<double>* parameters) {
  const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> by_row = rows;
  parameters->insert(parameters->end(), by_row.data(), by_row.data() + by_row.size());
}

/// Least squares solution; nothing when a parameter is not determined.
std::optional<Eigen::MatrixXd> solve(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right) {
  if (matrix.rows() < matrix.cols())
    return std::nullopt;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(matrix);
  qr.setThreshold(kLeastPivot);
  if (qr.rank() < matrix.cols())
    return std::nullopt;
  return Eigen::MatrixXd(qr.solve(right));
}

std::optional<Remap> fitPolynomial(Model model, const std::vector<KnownPoint>& points) {
  Remap remap = emptyRemap(model, points);
  const Frame frame = frameOf(remap.support);
  const int terms = model == Model::kTrilinear ? kTrilinearTerms : kAffineTerms;
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd matrix(n, terms);
  Eigen::MatrixXd displacements(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const KnownPoint& point = points[static_cast<std::size_t>(i)];
    matrix.row(i) = polynomial(frame.normalized(point.measured)).head(terms).transpose();
    displacements.row(i) = (point.known - point.measured).transpose();
  }
  const auto coefficients = solve(matrix, displacements);
  if (!coefficients)
    return std::nullopt;
  append(*coefficients, &remap.parameters);
  return remap;
}

/// P (1, q)' / (1 + c q), in normalised coordinates; parameters: P row by row, c. Gauss-Newton on
/// the distances, from no correction at all: it converges fast, because a rig's deformation is
/// small.
std::optional<Remap> fitProjective(const std::vector<KnownPoint>& points) {
  Remap remap = emptyRemap(Model::kProjective, points);
  const Frame frame = frameOf(remap.support);
  Eigen::VectorXd parameters = Eigen::VectorXd::Zero(15);
  Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> numerator(parameters.data());
  numerator.rightCols<3>().setIdentity();
  const auto rows = static_cast<Eigen::Index>(3 * points.size());
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(rows, parameters.size());
  Eigen::VectorXd residuals(rows);
  for (int iteration = 0; iteration < 20; ++iteration) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(3 * i);
      const Eigen::Vector3d q = frame.normalized(points[i].measured);
      const double denominator = 1.0 + parameters.tail<3>().dot(q);
      if (denominator < 0.05)
        return std::nullopt;
      const Eigen::Vector4d terms(1.0, q.x(), q.y(), q.z());
      const Eigen::Vector3d mapped = numerator * terms / denominator;
      residuals.segment<3>(row) = frame.normalized(points[i].known) - mapped;
      for (Eigen::Index axis = 0; axis < 3; ++axis)
        jacobian.block<1, 4>(row + axis, 4 * axis) = terms.transpose() / denominator;
      jacobian.block<3, 3>(row, 12) = -mapped * q.transpose() / denominator;
    }
    const auto step = solve(jacobian, residuals);
    if (!step)
      return std::nullopt;
    parameters += step->col(0);
    if (step->norm() < 1e-12)
      break;
  }
  for (Eigen::Index i = 0; i < parameters.size(); ++i)
    remap.parameters.push_back(frame.scale * parameters[i]);
  return remap;
}

/// A smoothed thin plate in three dimensions: least sum of squared distances plus smoothing times
/// bending, whose kernel is -r (Duchon 1977; Wahba, Spline Models for Observational Data, 1990).
/// With the smoothing whose leave-one-out errors are least. Nothing if the points do not determine
/// it.
std::optional<FittedModel> fitThinPlate(const std::vector<KnownPoint>& points) {
  const auto n = static_cast<Eigen::Index>(points.size());
  FittedModel best;
  best.remap = emptyRemap(Model::kThinPlate, points);
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
    append(weights.bottomRows(kAffineTerms), &best.remap.parameters);
    append(-weights.topRows(n), &best.remap.parameters);
  }
  if (best.left_out_errors.empty())
    return std::nullopt;
  return best;
}

/// As FittedModel::left_out_errors, of the models with a fixed number of parameters.
std::vector<double> leftOutErrors(Model model, const std::vector<KnownPoint>& points) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::vector<KnownPoint> others = points;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const auto remap = fitParameters(model, others);
    errors.push_back(remap ? errorOf(*remap, points[i]) : std::numeric_limits<double>::infinity());
    if (!std::isfinite(errors.back()))
      return {};
  }
  return errors;
}

}  // namespace

std::size_t minimumPoints(Model model) {
  switch (model) {  // as many as determine it, and some more to judge it
    case Model::kAffine:
      return 4 + 2;
    case Model::kProjective:
      return 5 + 2;
    case Model::kTrilinear:
      return 8 + 2;
    default:
      return 4 + 4;
  }
}

std::optional<Remap> fitParameters(Model model, const std::vector<KnownPoint>& points) {
  return model == Model::kProjective ? fitProjective(points) : fitPolynomial(model, points);
}

std::optional<FittedModel> fitModel(Model model, const std::vector<KnownPoint>& points) {
  if (model == Model::kThinPlate)
    return fitThinPlate(points);
  const auto remap = fitParameters(model, points);
  if (!remap)
    return std::nullopt;
  return FittedModel{*remap, leftOutErrors(model, points)};
}

double errorOf(const Remap& remap, const KnownPoint& point) {
  const auto mapped = evaluate(remap, frameOf(remap.support), point.measured);
  return mapped ? (mapped->position - point.known).norm() : std::numeric_limits<double>::infinity();
}

}  // namespace wiimote_tracker::remap
