#pragma once

#include "wiimote_tracker_calibration/remap/fit.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_msgs/text.h>
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
  void requireNew(const Eigen::Vector3d& known) const {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if ((known - points_[i].known).norm() < kSamePlace)
        throw Error(format(
            "place %zu has these coordinates already: correct them or, if that one is wrong, "
            "drop the places from %zu on and measure them again",
            i + 1, i + 1));
    }
  }

  /// A clause about an earlier place elsewhere that was measured where this one was, as when the
  /// LED was not carried on; empty: there is none.
  std::string describeUnmoved(const KnownPoint& point) const {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if ((point.measured - points_[i].measured).norm() < kUnmoved &&
          (point.known - points_[i].known).norm() > kApart)
        return format(
            "; but the LED is where place %zu was measured: drop the wrong one of the two", i + 1);
    }
    return "";
  }

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
  // An LED that was not carried on is measured within this distance of where it was [m].
  static constexpr double kUnmoved = 0.01;
  // Known places nearer to each other are one [m].
  static constexpr double kSamePlace = 0.001;
  // No correction brings places farther apart than this so near to each other [m].
  static constexpr double kApart = 0.1;

  std::string rig_id_;
  std::vector<KnownPoint> points_;
};

}  // namespace wiimote_tracker::remap
