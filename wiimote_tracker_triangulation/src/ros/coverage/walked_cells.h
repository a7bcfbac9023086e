#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_COVERAGE_WALKED_CELLS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_COVERAGE_WALKED_CELLS_H

#include "geometry/coverage.h"

#include <wiimote_tracker_msgs/TrackedPointArray.h>

#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Where the cameras of the rig in use have seen an LED.
class WalkedCells {
 public:
  /// @param cells of the grid. What was seen is kept if they are where those of the rig before
  /// were, which a correction of the rig hardly changes.
  void setRig(const std::string& rig_id,
              const geometry::CellGrid& grid,
              const std::vector<geometry::CoverageCell>& cells);

  /// @returns whether this shows something new.
  bool add(const wiimote_tracker_msgs::TrackedPointArray& points);

  /// With the most cameras that saw an LED there at once.
  const std::vector<geometry::CoverageCell>& cells() const { return cells_; }

 private:
  std::string rig_id_;
  std::optional<geometry::CellGrid> grid_;
  std::vector<geometry::CoverageCell> cells_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_COVERAGE_WALKED_CELLS_H
