#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_CLOCK_OFFSET_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_CLOCK_OFFSET_H

#include <Eigen/Core>

namespace wiimote_tracker::tracking {

/// By how much the times of a camera's images are too late, from the motion of LEDs that other
/// cameras locate: a recursive least-squares regression of the residuals on the velocities. Its
/// intercept takes what a constant error of the calibration causes.
class ClockOffset {
 public:
  struct Estimate {
    double offset;    ///< [s]
    double variance;  ///< [s^2]
  };

  /// @param velocity with which an offset shows in the residual [px/s].
  /// @param forward what 1 m along the LED's motion is in the image [px/m].
  /// @param residual of the LED's spot [px].
  /// @param correction that was subtracted from the image's time [s].
  void add(const Eigen::Vector2d& velocity,
           const Eigen::Vector2d& forward,
           const Eigen::Vector2d& residual,
           double correction);

  /// @param prior_stddev of the offset about 0 before any image [s, >= 0]; infinite: unknown.
  /// @param lag of the predictions behind the LEDs [m].
  Estimate estimate(double prior_stddev, double lag) const;

  // Their quotient is the lag if the offset is 0.
  double forwardResidual() const { return forward_residual_; }
  double forwardSquared() const { return squared_forward_; }

 private:
  double count_ = 0.0;
  Eigen::Vector2d velocity_ = Eigen::Vector2d::Zero();  // sums
  Eigen::Vector2d forward_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d residual_ = Eigen::Vector2d::Zero();
  double squared_velocity_ = 0.0;
  double squared_forward_ = 0.0;
  double squared_residual_ = 0.0;
  double velocity_forward_ = 0.0;
  double velocity_residual_ = 0.0;
  double forward_residual_ = 0.0;
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_CLOCK_OFFSET_H
