#pragma once

#include "wiimote_tracker_triangulation/gesture/shape.h"

#include <Eigen/Core>

namespace wiimote_tracker::simulation {

/// A path drawn in the air, relative to the centre of its bounding box.
class Drawing {
 public:
  /// @param path increasing times [s]; any unit of length. @param size longest side of the drawn
  /// box [m, > 0]. @param rest time without motion before and after [s, >= 0].
  /// @throws std::invalid_argument: fewer than two points, times that do not increase, positions
  /// that are not finite or all equal.
  Drawing(const gesture::Path& path, double size, double rest);

  double rest() const { return rest_; }          ///< [s]
  double duration() const { return duration_; }  ///< Without the rests [s].

  /// Position relative to the centre of the box [m], `time` [s] after the start of the drawing.
  /// Before and after it: its ends.
  Eigen::Vector3d position(double time) const;

 private:
  gesture::Path path_;  // starts at time 0 [s]; relative to the box's centre [m]
  double rest_;
  double duration_;
};

}  // namespace wiimote_tracker::simulation
