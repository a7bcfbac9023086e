#ifndef WIIMOTE_TRACKER_BRINGUP_SIMULATION_LED_MOTION_H
#define WIIMOTE_TRACKER_BRINGUP_SIMULATION_LED_MOTION_H

#include "drawing.h"
#include "wave_path.h"

#include <Eigen/Core>

#include <cstdint>
#include <optional>

namespace wiimote_tracker::simulation {

/// Where an LED is, as a function of time: it lies, goes straight to a place, circles, is
/// waved, or draws. A new motion begins where the LED is at that moment. Positions [m], times [s],
/// speeds [m/s].
class LedMotion {
 public:
  explicit LedMotion(const Eigen::Vector3d& position) : from_(position), to_(position) {}

  /// Position at `time`; before the beginning of the present motion: where it began.
  Eigen::Vector3d position(double time) const;

  /// From `time` on it stays where it is.
  void hold(double time);

  /// From `time` on it goes straight to `target` and stays there. Speed 0: it is there at once.
  /// @returns when it is there.
  double line(double time, const Eigen::Vector3d& target, double speed);

  /// From `time` on it goes straight to the +x side of the horizontal circle around `center`, then
  /// circles for ever, counter-clockwise seen from above. `radius` [m, > 0], `speed` [m/s, > 0].
  /// @returns when its first lap begins.
  double circle(double time, const Eigen::Vector3d& center, double radius, double speed);

  /// From `time` on it goes straight to the beginning of a WavePath, then follows that for ever.
  /// @returns when the wave begins.
  double wave(double time,
              const Eigen::Vector3d& middle,
              const Eigen::Vector3d& sides,
              double speed,
              std::uint32_t seed);

  /// From `time` on it goes straight to the beginning of the drawing, whose box is about `middle`,
  /// rests, draws it once, and stays at its end. Speed 0: it is at the beginning at once.
  /// @returns when the drawing begins.
  double draw(double time, const Drawing& drawing, const Eigen::Vector3d& middle, double speed);

  /// Whether it draws at `time`, the rests before and after left out.
  bool isDrawing(double time) const;

 private:
  double begin_ = 0.0;    ///< Of the straight part [s].
  double arrival_ = 0.0;  ///< End of the straight part [s].
  Eigen::Vector3d from_;
  Eigen::Vector3d to_;
  double radius_ = 0.0;             ///< Of the circle that follows; 0: none.
  double angular_speed_ = 0.0;      ///< [rad/s]
  std::optional<WavePath> wave_;    ///< That follows.
  std::optional<Drawing> drawing_;  ///< That follows, about middle_.
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
};

}  // namespace wiimote_tracker::simulation

#endif  // WIIMOTE_TRACKER_BRINGUP_SIMULATION_LED_MOTION_H
