#ifndef WIIMOTE_TRACKER_TRIANGULATION_MOTION_PIXEL_PREDICTION_H
#define WIIMOTE_TRACKER_TRIANGULATION_MOTION_PIXEL_PREDICTION_H

#include "wiimote_tracker_triangulation/motion/innovations.h"

#include <Eigen/Core>

#include <optional>

namespace wiimote_tracker::motion {

/// How exact a pixel is.
struct PixelNoise {
  double pixel_stddev = 0.5;  ///< Of each coordinate [px, > 0].
  double stamp_stddev = 0.0;  ///< Of the image's time [s, >= 0]: a moving LED smears along its way.
};

/// Where in an image several states of an LED are expected.
template <typename Numbers>
struct StateImages {
  Numbers weights;                          ///< Probabilities [0..1]; 0: to be left out.
  Numbers u, v;                             ///< Means, from PixelPrediction::pixel() [px].
  Numbers whiten_uu, whiten_vu, whiten_vv;  ///< Lower triangle that whitens [1/px].
};

/// Where in a camera's image an LED is expected: a mixture of normal distributions, one for each
/// way it may rest or move (see MotionOptions).
class PixelPrediction {
 public:
  const Eigen::Vector2d& pixel() const { return pixel_; }  ///< Mean [px].

  /// Innovation covariance: of a measured pixel about the mean, noise and all [px^2].
  Eigen::Matrix2d covariance() const;

  /// Squared Mahalanobis distance to the nearest of the ways, however unlikely that way is [1]: for
  /// gates, so that a sudden start is not shut out. For the LED's own spot no more than chi square
  /// with two degrees of freedom. NaN for a pixel that is.
  double squaredDistance(const Eigen::Vector2d& pixel) const;

  /// Logarithm of the density of the LED's spot [1/px^2].
  double logLikelihood(const Eigen::Vector2d& pixel) const;

  /// The same, but nothing where squaredDistance is not within the gate [1, >= 1]. What is far from
  /// all that is expected costs little.
  std::optional<double> logLikelihoodWithin(double gate, const Eigen::Vector2d& pixel) const;

 private:
  friend class MotionFilter;

  /// Distances of one pixel to each way [1].
  struct SquaredDistances {
    Pair resting;
    Lanes moving;
    double least;
  };
  SquaredDistances squaredDistances(const Eigen::Vector2d& pixel) const;
  double logDensity(const SquaredDistances& distances) const;

  Eigen::Vector2d pixel_;
  Eigen::Matrix<double, 2, 3> jacobian_;  // d pixel / d position [px/m]
  Eigen::Vector3d smear_;                 // standard deviation that the stamp's makes [m]
  double pixel_variance_;                 // [px^2]
  double squared_reach_;  // a pixel within gate g is not further than sqrt(g) times this [px^2]
  StateImages<Pair> resting_;
  StateImages<Lanes> moving_;
};

}  // namespace wiimote_tracker::motion

#endif  // WIIMOTE_TRACKER_TRIANGULATION_MOTION_PIXEL_PREDICTION_H
