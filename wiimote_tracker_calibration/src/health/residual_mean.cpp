#include "residual_mean.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::health {

namespace {

// Standard deviation over median distance from the median, and of the median over that of the
// mean, for Gaussian errors.
constexpr double kStddevOverDeviation = 1.4826;
constexpr double kMedianOverMean = 1.2533;
// Rounding does not scatter while the LED hardly moves [px].
constexpr double kLeastScatter = 0.3;
// Squared distance that chance reaches once in 1000 times, for one and for two dimensions
// (chi-squared).
constexpr double kBeyondChance[] = {10.8, 13.8};

double medianOf(std::vector<double>* values) {
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

}  // namespace

std::optional<Drift> meanOf(const std::vector<Residual>& residuals,
                            const Eigen::MatrixXd& covariance,
                            int dimensions,
                            double limit) {
  if (residuals.size() < kLeastResiduals)
    return std::nullopt;
  Drift drift;
  Eigen::Matrix2d expected = Eigen::Matrix2d::Zero();
  std::vector<double> values(residuals.size());
  for (int axis = 0; axis < dimensions; ++axis) {
    const auto each = [&](const auto& value) {
      std::transform(residuals.begin(), residuals.end(), values.begin(),
                     [&](const Residual& residual) { return value(residual.value[axis]); });
      return medianOf(&values);
    };
    const double median = each([](double value) { return value; });
    const double deviation = each([&](double value) { return std::abs(value - median); });
    const double scatter = std::max(kLeastScatter, kStddevOverDeviation * deviation);
    drift.bias[axis] = median;
    expected(axis, axis) = kMedianOverMean * kMedianOverMean * scatter * scatter /
                           static_cast<double>(residuals.size());
  }
  if (covariance.size() > 0) {
    Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(2, covariance.rows());
    double count = 0.0;
    for (const Residual& residual : residuals) {
      if (residual.by_parameters.size() == 0)
        continue;
      mean += residual.by_parameters;
      count += 1.0;
    }
    if (count > 0.0)
      expected += mean * covariance * mean.transpose() / (count * count);
  }
  const auto n = static_cast<Eigen::Index>(dimensions);
  const Eigen::VectorXd bias = drift.bias.head(n);
  const Eigen::MatrixXd known = expected.topLeftCorner(n, n);
  const double distance = bias.dot(known.inverse() * bias);
  drift.stddev = std::sqrt(known.trace());
  drift.ratio = std::min(bias.norm() / limit, std::sqrt(distance / kBeyondChance[dimensions - 1]));
  return drift;
}

}  // namespace wiimote_tracker::health
