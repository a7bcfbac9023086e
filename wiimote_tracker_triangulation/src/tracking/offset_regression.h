#pragma once

#include <Eigen/Core>

#include <complex>
#include <optional>

namespace wiimote_tracker::tracking {

/// By how much the times of a camera's images are too late, from the motion of LEDs that other
/// cameras locate: a least-squares regression of the residuals on the velocities. Errors of the
/// calibration, which shift, turn and stretch the image, are estimated beside it: before an LED on
/// a circle a turned camera looks like a wrong time.
class OffsetRegression {
 public:
  using Complex = std::complex<double>;  ///< A vector of the image.

  struct Estimate {
    double offset;      ///< [s]
    double variance;    ///< Of what differs from one estimate to the next [s^2].
    double bias = 0.0;  ///< Variance of what the calibration may add to all of them [s^2].
  };

  /// @param pixel of an LED's spot, as predicted. @param velocity of it [px/s].
  /// @param residual of it [px].
  void add(const Eigen::Vector2d& pixel,
           const Eigen::Vector2d& velocity,
           const Eigen::Vector2d& residual);

  /// Nothing where nothing moved.
  /// @param turn_stddev how well the camera's turn about its axis [rad] and the stretch of its
  /// image [1] are known.
  std::optional<Estimate> estimate(double turn_stddev) const;

  double count() const { return count_; }  ///< Of the spots.

 private:
  using Products = Eigen::Vector2cd;  // conj(p) q and p q of a pixel p and a vector q

  double count_ = 0.0;
  Complex pixel_;  // sums, as all below
  Complex velocity_;
  Complex residual_;
  Products pixel_pixel_ = Products::Zero();
  Products pixel_velocity_ = Products::Zero();
  Products pixel_residual_ = Products::Zero();
  double velocity_residual_ = 0.0;  // inner product
  double squared_velocity_ = 0.0;
  double squared_residual_ = 0.0;
};

}  // namespace wiimote_tracker::tracking
