#pragma once

#include "geometry/coverage.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <wiimote_tracker_msgs/TrackedPointArray.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker {

/// Where the cameras of the rig in use have seen an LED.
class WalkedCells {
 public:
  /// @param cells of the grid. What was seen is kept if they are where those of the rig before
  /// were, which a correction of the rig hardly changes.
  void setRig(const std::string& rig_id,
              const geometry::CellGrid& grid,
              const std::vector<geometry::CoverageCell>& cells) {
    const bool keep = areSame(cells_, cells);
    std::vector<CoverageCell> walked = cells;
    for (std::size_t i = 0; i < walked.size(); ++i)
      walked[i].cameras = keep ? cells_[i].cameras : 0;
    cells_ = std::move(walked);
    rig_id_ = rig_id;
    grid_ = grid;
  }

  /// @returns whether this shows something new.
  bool add(const wiimote_tracker_msgs::TrackedPointArray& points) {
    using wiimote_tracker_msgs::TrackedPoint;
    if (!grid_ || points.rig_id != rig_id_)
      return false;
    bool changed = false;
    for (const TrackedPoint& point : points.points) {
      // With one camera the place is extrapolated, which is near enough for a cell.
      if (point.state != TrackedPoint::TRACKED && point.state != TrackedPoint::PREDICTED)
        continue;
      const auto cell = grid_->cellAt(vectorOf(point.position));
      if (!cell || cells_[*cell].cameras >= point.rays_used)
        continue;
      cells_[*cell].cameras = point.rays_used;
      changed = true;
    }
    return changed;
  }

  /// With the most cameras that saw an LED there at once.
  const std::vector<geometry::CoverageCell>& cells() const { return cells_; }

 private:
  using CoverageCell = geometry::CoverageCell;

  /// Whether the cells are at the same places, but for what a correction of the rig moves.
  static bool areSame(const std::vector<CoverageCell>& a, const std::vector<CoverageCell>& b) {
    constexpr double kSamePlace = 0.02;  // [m]
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const CoverageCell& x, const CoverageCell& y) {
                        return (x.center - y.center).norm() < kSamePlace;
                      });
  }

  std::string rig_id_;
  std::optional<geometry::CellGrid> grid_;
  std::vector<geometry::CoverageCell> cells_;
};

}  // namespace wiimote_tracker
