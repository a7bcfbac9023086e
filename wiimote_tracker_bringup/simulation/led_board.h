#ifndef WIIMOTE_TRACKER_BRINGUP_SIMULATION_LED_BOARD_H
#define WIIMOTE_TRACKER_BRINGUP_SIMULATION_LED_BOARD_H

#include "description.h"
#include "virtual_camera.h"

#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <vector>

namespace wiimote_tracker::simulation {

/// A flat board of 4 x 4 LEDs, from which a lens is calibrated, held before one camera. It lights
/// its LEDs in the sequence of wiimote_tracker_calibration/doc/board.md, from time 0 on.
class LedBoard {
 public:
  /// @param camera before which it is held.
  LedBoard(const BoardDescription& description, const geometry::Camera& camera);

  /// Holds it still somewhere new: 0.55 to 1 m away, tilted by 20 to 45 degrees to any side.
  /// @param pose another one for each number; the same for the same.
  void show(std::uint32_t pose);

  void setLit(bool lit) { lit_ = lit; }

  /// Adds the LEDs that shine at `time` [s].
  void addLamps(double time, std::vector<Lamp>* lamps) const;

 private:
  BoardDescription description_;
  Eigen::Isometry3d world_from_camera_;
  Eigen::Isometry3d world_from_board_;  ///< x along the rows, y down the columns.
  bool lit_ = false;
};

}  // namespace wiimote_tracker::simulation

#endif  // WIIMOTE_TRACKER_BRINGUP_SIMULATION_LED_BOARD_H
