#include "wiimote_tracker_triangulation/motion/pixel_prediction.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::motion {
namespace {

using Vector2 = Eigen::Vector2d;
using Matrix2 = Eigen::Matrix2d;

template <typename Numbers>
Numbers squaredDistancesTo(const StateImages<Numbers>& images, const Vector2& from_mean) {
  const Numbers u = from_mean.x() - images.u;
  const Numbers v = from_mean.y() - images.v;
  return (images.whiten_uu * u).square() + (images.whiten_vu * u + images.whiten_vv * v).square();
}

/// Of those that count. NaN where one of these is.
template <typename Numbers>
double leastOf(const Numbers& distances, const Numbers& weights, double least) {
  for (int i = 0; i < distances.size(); ++i) {
    if (weights[i] > 0.0 && !(distances[i] >= least))
      least = distances[i];
  }
  return least;
}

/// Sum of the densities, times 2 pi and over exp(-least / 2). What does not count may be nearer
/// than the least of those that do; nothing times infinity would be no number.
template <typename Numbers>
double densityOver(double least, const StateImages<Numbers>& images, const Numbers& distances) {
  return (images.weights * images.whiten_uu * images.whiten_vv *
          (0.5 * (least - distances)).min(0.0).exp())
      .sum();
}

/// Adds to the first and second moments.
template <typename Numbers>
void addMoments(const StateImages<Numbers>& images, Vector2* first, Matrix2* second) {
  for (int i = 0; i < images.weights.size(); ++i) {
    if (!(images.weights[i] > 0.0))
      continue;
    const double l_uu = 1.0 / images.whiten_uu[i];
    const double l_vv = 1.0 / images.whiten_vv[i];
    Matrix2 lower;
    lower << l_uu, 0.0, -images.whiten_vu[i] * l_uu * l_vv, l_vv;
    const Vector2 offset(images.u[i], images.v[i]);
    *first += images.weights[i] * offset;
    *second += images.weights[i] * (lower * lower.transpose() + offset * offset.transpose());
  }
}

}  // namespace

Matrix2 PixelPrediction::covariance() const {
  Vector2 mean = Vector2::Zero();
  Matrix2 second = Matrix2::Zero();
  addMoments(resting_, &mean, &second);
  addMoments(moving_, &mean, &second);
  return second - mean * mean.transpose();
}

PixelPrediction::SquaredDistances PixelPrediction::squaredDistances(const Vector2& pixel) const {
  const Vector2 from_mean = pixel - pixel_;
  SquaredDistances result;
  result.resting = squaredDistancesTo(resting_, from_mean);
  result.moving = squaredDistancesTo(moving_, from_mean);
  result.least = leastOf(result.resting, resting_.weights, std::numeric_limits<double>::infinity());
  result.least = leastOf(result.moving, moving_.weights, result.least);
  return result;
}

double PixelPrediction::logDensity(const SquaredDistances& distances) const {
  const double sum = densityOver(distances.least, resting_, distances.resting) +
                     densityOver(distances.least, moving_, distances.moving);
  return std::log(sum / (2.0 * M_PI)) - 0.5 * distances.least;
}

double PixelPrediction::squaredDistance(const Vector2& pixel) const {
  return squaredDistances(pixel).least;
}

double PixelPrediction::logLikelihood(const Vector2& pixel) const {
  return logDensity(squaredDistances(pixel));
}

std::optional<double> PixelPrediction::logLikelihoodWithin(double gate,
                                                           const Vector2& pixel) const {
  if ((pixel - pixel_).squaredNorm() > gate * squared_reach_)
    return std::nullopt;
  const SquaredDistances distances = squaredDistances(pixel);
  if (!(distances.least <= gate))
    return std::nullopt;
  return logDensity(distances);
}

}  // namespace wiimote_tracker::motion
