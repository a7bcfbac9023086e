#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_CLOCK_OFFSET_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_CLOCK_OFFSET_H

#include <Eigen/Core>

#include <optional>

namespace wiimote_tracker::tracking {

/// By how much the times of a camera's images are too late, from the motion of LEDs that other
/// cameras locate: a least-squares regression of the residuals on the velocities. Its intercept
/// takes what a constant error of the calibration causes.
class ClockOffset {
 public:
  struct Estimate {
    double offset;    ///< [s]
    double variance;  ///< [s^2]
  };

  /// @param velocity of an LED's spot [px/s]. @param residual of it [px].
  void add(const Eigen::Vector2d& velocity, const Eigen::Vector2d& residual);

  /// Nothing where nothing moved.
  std::optional<Estimate> estimate() const;

  double count() const { return count_; }  ///< Of the spots.

 private:
  double count_ = 0.0;
  Eigen::Vector2d velocity_ = Eigen::Vector2d::Zero();  // sums
  Eigen::Vector2d residual_ = Eigen::Vector2d::Zero();
  double squared_velocity_ = 0.0;
  double squared_residual_ = 0.0;
  double velocity_residual_ = 0.0;
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_CLOCK_OFFSET_H
