#pragma once

#include "drawing.h"

#include <Eigen/Core>

#include <cstdint>
#include <functional>

namespace wiimote_tracker::simulation {

/// Position of an LED as a function of time: at rest, or moving along a line, a circle, a wave or a
/// drawing. A new motion starts at the present position. Positions [m], times [s], speeds [m/s].
class LedMotion {
 public:
  /// Position by the time since its start.
  using Path = std::function<Eigen::Vector3d(double)>;

  explicit LedMotion(const Eigen::Vector3d& position) : from_(position), to_(position) {}

  /// Position at `time`; before the present motion, its starting point.
  Eigen::Vector3d position(double time) const;

  /// Stops at `time`.
  void hold(double time);

  /// Moves straight to `target` from `time` on as a hand does, and stays there. The speed is the
  /// mean one: it begins and ends at 0, with 15/8 of the mean between. Speed 0: immediately.
  /// @returns the time of arrival.
  double line(double time, const Eigen::Vector3d& target, double speed);

  /// From `time` on moves straight to the +x side of the horizontal circle around `center`, then
  /// circles, counter-clockwise seen from above. `radius` [m, > 0], `speed` [m/s, > 0].
  /// @returns the start of the first lap.
  double circle(double time, const Eigen::Vector3d& center, double radius, double speed);

  /// From `time` on moves straight to the start of a wave, then follows it: a smooth path of a hand
  /// that waves through a box with these `sides` [m, > 0], selected by `seed`, whose laps do not
  /// repeat. `speed`: RMS over a long time [m/s, > 0]. @returns the start of the wave.
  double wave(double time,
              const Eigen::Vector3d& middle,
              const Eigen::Vector3d& sides,
              double speed,
              std::uint32_t seed);

  /// From `time` on moves straight to the start of the drawing, whose box is centred at `middle`,
  /// rests, draws once, and stays at the end. Speed 0: it is at the start immediately.
  /// @returns the start of the drawing.
  double draw(double time, const Drawing& drawing, const Eigen::Vector3d& middle, double speed);

  /// Whether it draws at `time`, excluding the rests before and after.
  bool isDrawing(double time) const;

 private:
  double begin_ = 0.0;    ///< Of the straight part [s].
  double arrival_ = 0.0;  ///< End of the straight part [s].
  Eigen::Vector3d from_;
  Eigen::Vector3d to_;
  Path then_;                   ///< From the arrival on; empty: it stays.
  double drawing_begin_ = 0.0;  ///< Without the rests [s].
  double drawing_end_ = -1.0;   ///< Before the beginning: it does not draw.
};

}  // namespace wiimote_tracker::simulation
