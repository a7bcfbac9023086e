#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_REMAP_MEASURED_POINTS_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_REMAP_MEASURED_POINTS_H

#include "wiimote_tracker_calibration/remap/fit.h"

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker::remap {

/// The known points to fit a correction of the volume to. All are measured with one calibration,
/// which continuous calibration may have adjusted since, without the present correction.
class MeasuredPoints {
 public:
  /// Sets the calibration in use (geometry::Rig::id()). @returns how many points of another one
  /// were dropped.
  std::size_t useRig(const std::string& rig_id) {
    if (rig_id == rig_id_)
      return 0;
    const std::size_t dropped = points_.size();
    points_.clear();
    rig_id_ = rig_id;
    return dropped;
  }

  /// The calibration has another id now, by masks or small adjustments.
  void renameRig(const std::string& before, const std::string& now) {
    if (rig_id_ == before)
      rig_id_ = now;
  }

  /// @throws Error: a place with these coordinates is there already.
  void requireNew(const Eigen::Vector3d& known) const;

  /// A clause about an earlier place elsewhere that was measured where this one was, as when the
  /// LED was not carried on; empty: there is none.
  std::string describeUnmoved(const KnownPoint& point) const;

  void add(const KnownPoint& point) { points_.push_back(point); }

  /// Drops the latest. @returns false when there is none.
  bool undo() {
    if (points_.empty())
      return false;
    points_.pop_back();
    return true;
  }

  void clear() { points_.clear(); }

  const std::vector<KnownPoint>& points() const { return points_; }

 private:
  std::string rig_id_;
  std::vector<KnownPoint> points_;
};

}  // namespace wiimote_tracker::remap

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_REMAP_MEASURED_POINTS_H
