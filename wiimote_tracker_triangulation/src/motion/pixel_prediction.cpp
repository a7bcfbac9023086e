#include "motion/pixel_prediction.h"

#include <Eigen/LU>

#include <cmath>
#include <limits>

namespace wiimote_tracker::motion {

using Eigen::Matrix2d;
using Eigen::Vector2d;

Matrix2d PixelPrediction::covariance() const {
  Vector2d mean = Vector2d::Zero();
  Matrix2d second_moment = Matrix2d::Zero();
  for (const ModePixel& mode : modes_) {
    if (!(mode.probability > 0.0))
      continue;
    const Matrix2d L = mode.whitening.inverse();
    mean += mode.probability * mode.offset;
    second_moment += mode.probability * (L * L.transpose() + mode.offset * mode.offset.transpose());
  }
  return second_moment - mean * mean.transpose();
}

PixelPrediction::Distances PixelPrediction::distancesTo(const Vector2d& pixel) const {
  Distances result;
  result.least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kModes; ++i) {
    const ModePixel& mode = modes_[i];
    if (!(mode.probability > 0.0))
      continue;
    result.squared[i] = (mode.whitening * (pixel - pixel_ - mode.offset)).squaredNorm();
    if (!(result.squared[i] >= result.least))
      result.least = result.squared[i];
  }
  return result;
}

double PixelPrediction::scaledDensity(int mode, const Distances& distances) const {
  const Matrix2d& whitening = modes_[mode].whitening;
  return whitening(0, 0) * whitening(1, 1) *
         std::exp(0.5 * (distances.least - distances.squared[mode]));
}

double PixelPrediction::logDensity(const Distances& distances) const {
  double sum = 0.0;
  for (int i = 0; i < kModes; ++i) {
    if (modes_[i].probability > 0.0)
      sum += modes_[i].probability * scaledDensity(i, distances);
  }
  return std::log(sum / (2.0 * M_PI)) - 0.5 * distances.least;
}

double PixelPrediction::squaredDistance(const Vector2d& pixel) const {
  return distancesTo(pixel).least;
}

double PixelPrediction::logLikelihood(const Vector2d& pixel) const {
  return logDensity(distancesTo(pixel));
}

std::optional<double> PixelPrediction::logLikelihoodWithin(double gate,
                                                           const Vector2d& pixel) const {
  const Distances distances = distancesTo(pixel);
  if (!(distances.least <= gate))
    return std::nullopt;
  return logDensity(distances);
}

}  // namespace wiimote_tracker::motion
