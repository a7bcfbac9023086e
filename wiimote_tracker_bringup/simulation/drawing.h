#ifndef WIIMOTE_TRACKER_BRINGUP_SIMULATION_DRAWING_H
#define WIIMOTE_TRACKER_BRINGUP_SIMULATION_DRAWING_H

#include "wiimote_tracker_triangulation/gesture/shape.h"

#include <Eigen/Core>

namespace wiimote_tracker::simulation {

/// A path that a hand draws in the air, about the middle of its box.
class Drawing {
 public:
  /// @param path times [s] that increase; any unit of length. @param size longest side of its box
  /// when it is drawn [m, > 0]. @param rest for which the hand is still before and after [s, >= 0].
  /// @throws std::invalid_argument: fewer than two points, times that do not increase, positions
  /// that are not finite or all the same.
  Drawing(const gesture::Path& path, double size, double rest);

  double rest() const { return rest_; }          ///< [s]
  double duration() const { return duration_; }  ///< Without the rests [s].

  /// From the middle of the box [m], `time` [s] after the drawing began. Before and after it: its
  /// ends.
  Eigen::Vector3d position(double time) const;

 private:
  gesture::Path path_;  // from time 0 on [s], from the middle of its box [m]
  double rest_;
  double duration_;
};

}  // namespace wiimote_tracker::simulation

#endif  // WIIMOTE_TRACKER_BRINGUP_SIMULATION_DRAWING_H
