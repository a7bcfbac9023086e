#pragma once

#include "description.h"
#include "virtual_camera.h"

#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <vector>

namespace wiimote_tracker::simulation {

/// A flat board of 4 x 4 LEDs for lens calibration, in front of one camera. From time 0 on it
/// lights its LEDs in the sequence of wiimote_tracker_calibration/doc/board.md.
class LedBoard {
 public:
  /// @param camera in front of which it is held.
  LedBoard(const BoardDescription& description, const geometry::Camera& camera);

  /// Moves it to another pose: 0.55 to 1 m away, tilted by 20 to 45 degrees in any direction.
  /// @param pose selects the pose.
  void show(std::uint32_t pose);

  void setLit(bool lit) { lit_ = lit; }

  /// Adds the LEDs that are on at `time` [s].
  void addLamps(double time, std::vector<Lamp>* lamps) const;

 private:
  BoardDescription description_;
  Eigen::Isometry3d world_from_camera_;
  Eigen::Isometry3d world_from_board_;  ///< x along the rows, y down the columns.
  bool lit_ = false;
};

}  // namespace wiimote_tracker::simulation
