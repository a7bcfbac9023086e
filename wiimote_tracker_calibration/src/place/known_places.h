#ifndef WIIMOTE_TRACKER_CALIBRATION_PLACE_KNOWN_PLACES_H
#define WIIMOTE_TRACKER_CALIBRATION_PLACE_KNOWN_PLACES_H

#include "wiimote_tracker_calibration/remap/fit.h"

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker::place {

/// The places to fit a correction of the volume to. All are measured with one calibration, without
/// the present correction.
class KnownPlaces {
 public:
  /// Sets the calibration in use (geometry::Rig::id()). @returns how many places of another one
  /// were dropped.
  std::size_t useRig(const std::string& rig_id) {
    if (rig_id == rig_id_)
      return 0;
    const std::size_t dropped = places_.size();
    places_.clear();
    rig_id_ = rig_id;
    return dropped;
  }

  /// The calibration has another id now, though no camera has moved.
  void renameRig(const std::string& before, const std::string& now) {
    if (rig_id_ == before)
      rig_id_ = now;
  }

  /// @throws Error: a place with these coordinates is there already; no fit takes it twice.
  void requireNew(const Eigen::Vector3d& known) const;

  /// A clause about an earlier place elsewhere that was measured where this one was, as when the
  /// LED was not carried on; empty: there is none.
  std::string describeUnmoved(const remap::KnownPoint& place) const;

  void add(const remap::KnownPoint& place) { places_.push_back(place); }

  /// Drops the latest. @returns false when there is none.
  bool undo() {
    if (places_.empty())
      return false;
    places_.pop_back();
    return true;
  }

  void clear() { places_.clear(); }

  const std::vector<remap::KnownPoint>& places() const { return places_; }

 private:
  std::string rig_id_;
  std::vector<remap::KnownPoint> places_;
};

}  // namespace wiimote_tracker::place

#endif  // WIIMOTE_TRACKER_CALIBRATION_PLACE_KNOWN_PLACES_H
