#include "merged_spot.h"

#include <Eigen/LU>

#include <cmath>

namespace wiimote_tracker::tracking {

double mergedProbability(const Eigen::Vector2d& spot,
                         const motion::PixelPrediction& visible,
                         const motion::PixelPrediction& absent,
                         double hidden,
                         double pixel_stddev,
                         double merging_distance) {
  constexpr double kSpread = 0.15;  // of the place between two LEDs, by their brightness [1]
  const Eigen::Vector2d between = absent.pixel() - visible.pixel();
  const double too_close = 1.0 - between.norm() / merging_distance;
  if (too_close <= 0.0)
    return 0.0;
  const Eigen::Vector2d residual = spot - visible.pixel() - 0.5 * between;
  const Eigen::Matrix2d covariance =
      0.25 * (visible.covariance() + absent.covariance()) +
      0.5 * pixel_stddev * pixel_stddev * Eigen::Matrix2d::Identity() +
      kSpread * kSpread * between * between.transpose();
  const double merged = -0.5 * residual.dot(covariance.inverse() * residual) -
                        std::log(2.0 * M_PI * std::sqrt(covariance.determinant()));
  const double log_odds =
      merged - visible.logLikelihood(spot) + std::log((1.0 - hidden) * too_close / hidden);
  return 1.0 / (1.0 + std::exp(-log_odds));
}

}  // namespace wiimote_tracker::tracking
