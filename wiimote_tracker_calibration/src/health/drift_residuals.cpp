#include "drift_residuals.h"

#include <wiimote_tracker_msgs/median.h>
#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/point_sensitivity.h>
#include <wiimote_tracker_triangulation/geometry/triangulate.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::health {

namespace {

constexpr std::size_t kLeastResiduals = 40;
// The derivative is computed for this many residuals; their mean is used for all.
constexpr std::size_t kDerivatives = 40;
// For Gaussian errors: standard deviation over median absolute deviation, and standard deviation of
// the median over that of the mean, sqrt(pi / 2).
constexpr double kStddevOverDeviation = 1.4826;
constexpr double kMedianOverMean = 1.2533;
// Least standard deviation: rounding does not scatter while the LED hardly moves [px].
constexpr double kLeastScatter = 0.3;
// 99.9 % quantiles of chi-squared, for one and two degrees of freedom.
constexpr double kQuantile[] = {10.8, 13.8};

/// One residual of a camera, and its derivative by the parameters of the rig.
struct Residual {
  Eigen::Vector2d value;          // Predicted less observed [px].
  Eigen::MatrixXd by_parameters;  // 2 x all parameters of the rig; empty: not computed.
};

/// Whether the derivative of the latest residual is computed.
bool isDifferentiated(const std::vector<Residual>& residuals, std::size_t samples) {
  return (residuals.size() - 1) % (samples / kDerivatives + 1) == 0;
}

std::optional<Eigen::Vector3d> triangulated(const std::vector<geometry::Sight>& sights) {
  const auto point = geometry::triangulate(sights.data(), sights.size(), {});
  if (!point)
    return std::nullopt;
  return point->position;
}

/// The derivative of a camera's residual: of its own pixel, and of the point that the others see.
Eigen::MatrixXd derivativeAgainst(const geometry::Rig& rig,
                                  const std::vector<std::size_t>& others,
                                  std::size_t camera,
                                  const Eigen::Vector3d& point) {
  const auto pixel = geometry::rayProjection(rig, camera, point);
  const auto by_parameters = geometry::pointByParameters(rig, point, others);
  if (!pixel || !by_parameters)
    return {};
  Eigen::MatrixXd derivative = pixel->by_point * *by_parameters;
  derivative.middleCols<geometry::kParameters>(geometry::firstParameter(camera)) +=
      pixel->by_parameters;
  return derivative;
}

/// The unit vector in the four pixels of two cameras that no point explains: across the epipolar
/// lines. Its sign is that of the epipolar plane, which turns slowly as the LED moves.
Eigen::Vector4d acrossEpipolarLines(const std::vector<geometry::Sight>& sights,
                                    const Eigen::Vector3d& point) {
  Eigen::Matrix<double, 4, 3> by_point;
  for (Eigen::Index i = 0; i < 2; ++i) {
    const geometry::Sight& sight = sights[static_cast<std::size_t>(i)];
    by_point.middleRows<2>(2 * i) = sight.pixel_by_offset / sight.depth(point);
  }
  // The cross product of three vectors in four dimensions: signed minors.
  Eigen::Vector4d across;
  for (Eigen::Index i = 0; i < 4; ++i) {
    Eigen::Matrix3d minor;
    minor << by_point.topRows(i), by_point.bottomRows(3 - i);
    across[i] = (i % 2 == 0 ? 1.0 : -1.0) * minor.determinant();
  }
  across.normalize();
  const Eigen::Vector3d normal = (sights[1].origin - sights[0].origin).cross(sights[0].direction);
  const bool opposite = across.head<2>().dot(sights[0].pixel_by_offset * normal) < 0.0;
  return (opposite ? -1.0 : 1.0) * across;
}

std::vector<Residual> residualsAgainst(const geometry::Rig& rig,
                                       const DriftSamples& samples,
                                       const std::vector<bool>& active,
                                       std::size_t camera) {
  std::vector<Residual> residuals;
  std::vector<std::size_t> others;
  std::vector<geometry::Sight> sights;
  for (const DriftSample& sample : samples) {
    const geometry::Sight* own = nullptr;
    others.clear();
    sights.clear();
    for (const auto& [index, sight] : sample.sights) {
      if (index == camera) {
        own = &sight;
      } else if (active[index]) {
        others.push_back(index);
        sights.push_back(sight);
      }
    }
    if (own == nullptr || others.size() < 2)
      continue;
    const auto point = triangulated(sights);
    if (!point || !(own->depth(*point) > 0.0))
      continue;
    residuals.push_back({own->residual(*point), {}});
    if (isDifferentiated(residuals, samples.size()) && geometry::hasCovariance(rig))
      residuals.back().by_parameters = derivativeAgainst(rig, others, camera, *point);
  }
  return residuals;
}

std::vector<Residual> residualsOfPair(const geometry::Rig& rig,
                                      const DriftSamples& samples,
                                      std::size_t a,
                                      std::size_t b) {
  std::vector<Residual> residuals;
  for (const DriftSample& sample : samples) {
    std::vector<std::size_t> cameras;
    std::vector<geometry::Sight> sights;
    for (const auto& [index, sight] : sample.sights) {
      if (index == a || index == b) {
        cameras.push_back(index);
        sights.push_back(sight);
      }
    }
    const auto point = sights.size() == 2 ? triangulated(sights) : std::nullopt;
    if (!point)
      continue;
    // An error of one camera alone has about 1 / sqrt(2) of its size along the unit vector.
    const Eigen::Vector4d across = std::sqrt(2.0) * acrossEpipolarLines(sights, *point);
    const double distance = across.head<2>().dot(sights[0].residual(*point)) +
                            across.tail<2>().dot(sights[1].residual(*point));
    residuals.push_back({Eigen::Vector2d(distance, 0.0), {}});
    if (!isDifferentiated(residuals, samples.size()) || !geometry::hasCovariance(rig))
      continue;
    Eigen::MatrixXd derivative = Eigen::MatrixXd::Zero(2, rig.covariance.rows());
    bool complete = true;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto pixel = geometry::rayProjection(rig, cameras[i], *point);
      complete = complete && pixel;
      if (complete)
        derivative.block<1, geometry::kParameters>(0, geometry::firstParameter(cameras[i])) =
            across.segment<2>(static_cast<Eigen::Index>(2 * i)).transpose() * pixel->by_parameters;
    }
    if (complete)
      residuals.back().by_parameters = derivative;
  }
  return residuals;
}

/// @param dimensions 2, or 1 for x only.
std::optional<Drift> medianDrift(const std::vector<Residual>& residuals,
                                 const Eigen::MatrixXd& covariance,
                                 int dimensions,
                                 double limit) {
  if (residuals.size() < kLeastResiduals)
    return std::nullopt;
  Drift drift;
  Eigen::Matrix2d expected = Eigen::Matrix2d::Zero();
  std::vector<double> values(residuals.size());
  for (int axis = 0; axis < dimensions; ++axis) {
    const auto medianOfEach = [&](const auto& value) {
      std::transform(residuals.begin(), residuals.end(), values.begin(),
                     [&](const Residual& residual) { return value(residual.value[axis]); });
      return medianOf(&values);
    };
    const double median = medianOfEach([](double value) { return value; });
    const double deviation = medianOfEach([&](double value) { return std::abs(value - median); });
    const double scatter = std::max(kLeastScatter, kStddevOverDeviation * deviation);
    drift.bias[axis] = median;
    drift.scatter = std::hypot(drift.scatter, scatter);
    expected(axis, axis) = kMedianOverMean * kMedianOverMean * scatter * scatter /
                           static_cast<double>(residuals.size());
  }
  Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(2, covariance.rows());
  double count = 0.0;
  for (const Residual& residual : residuals) {
    if (residual.by_parameters.size() == 0)
      continue;
    mean += residual.by_parameters;
    count += 1.0;
  }
  if (count > 0.0)
    expected += geometry::propagated(mean / count, covariance);
  const auto n = static_cast<Eigen::Index>(dimensions);
  const auto bias = drift.bias.head(n);
  const auto known = expected.topLeftCorner(n, n);
  const double distance = geometry::squaredMahalanobis(bias, known);
  drift.stddev = std::sqrt(known.trace());
  drift.ratio = std::min(bias.norm() / limit, std::sqrt(distance / kQuantile[dimensions - 1]));
  return drift;
}

}  // namespace

std::optional<Drift> driftOf(std::size_t camera,
                             const geometry::Rig& rig,
                             const DriftSamples& samples,
                             const std::vector<bool>& active,
                             double limit) {
  return medianDrift(residualsAgainst(rig, samples, active, camera), rig.covariance, 2, limit);
}

std::optional<Drift> driftOfPair(std::size_t a,
                                 std::size_t b,
                                 const geometry::Rig& rig,
                                 const DriftSamples& samples,
                                 double limit) {
  return medianDrift(residualsOfPair(rig, samples, a, b), rig.covariance, 1, limit);
}

}  // namespace wiimote_tracker::health
