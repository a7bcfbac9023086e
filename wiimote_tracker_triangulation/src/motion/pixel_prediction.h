#pragma once

#include "motion/modes.h"

#include <Eigen/Core>

#include <array>
#include <optional>

namespace wiimote_tracker::motion {

/// Where in a camera's image an LED is expected: a mixture of normal distributions, one per mode.
class PixelPrediction {
 public:
  const Eigen::Vector2d& pixel() const { return pixel_; }  ///< Mean [px].

  /// Velocity of the mean [px/s].
  Eigen::Vector2d velocity() const { return jacobian_ * velocity_; }

  /// Innovation covariance: of a measured pixel about the mean, with the measurement noise [px^2].
  Eigen::Matrix2d covariance() const;

  /// Squared Mahalanobis distance to the nearest mode, however unlikely that mode is [1]: for
  /// gating, so that a sudden start stays within the gate. For the LED's own spot at most chi
  /// square with two degrees of freedom. NaN for a pixel that is NaN.
  double squaredDistance(const Eigen::Vector2d& pixel) const;

  /// Logarithm of the density of the LED's spot [1/px^2].
  double logLikelihood(const Eigen::Vector2d& pixel) const;

  /// The same, or nothing where squaredDistance exceeds the gate [1].
  std::optional<double> logLikelihoodWithin(double gate, const Eigen::Vector2d& pixel) const;

 private:
  friend class MotionFilter;

  /// The normal distribution of one mode.
  struct ModePixel {
    double probability;         // [0..1]; where it is 0, the rest has no meaning
    Eigen::Vector2d offset;     // mean, from pixel_ [px]
    Eigen::Matrix2d whitening;  // L^-1 of the innovation covariance L L^T, lower triangular [1/px]
  };

  /// Squared Mahalanobis distances of one pixel [1].
  struct Distances {
    std::array<double, kModes> squared;
    double least;  // of modes with a probability; NaN for a pixel that is NaN
  };
  Distances distancesTo(const Eigen::Vector2d& pixel) const;

  /// Density of one mode times 2 pi exp(least / 2), so that it does not underflow for all modes.
  double scaledDensity(int mode, const Distances& distances) const;
  double logDensity(const Distances& distances) const;

  Eigen::Vector2d pixel_;
  Eigen::Matrix<double, 2, 3> jacobian_;  // d pixel / d position [px/m]
  Eigen::Vector3d velocity_;              // of the LED [m/s]
  double stamp_stddev_;                   // [s]
  double pixel_variance_;                 // [px^2]
  std::array<ModePixel, kModes> modes_;
};

}  // namespace wiimote_tracker::motion
