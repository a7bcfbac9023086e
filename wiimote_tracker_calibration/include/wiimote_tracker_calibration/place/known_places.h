#ifndef WIIMOTE_TRACKER_CALIBRATION_PLACE_KNOWN_PLACES_H
#define WIIMOTE_TRACKER_CALIBRATION_PLACE_KNOWN_PLACES_H

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker::place {

/// A place that is known, and where one rig measured it, without correction of the volume.
struct KnownPlace {
  Eigen::Vector3d known;     ///< World [m].
  Eigen::Vector3d measured;  ///< World [m].
};

/// The places that a correction of the volume is fitted from. All are measured with one
/// calibration: with another they are worth nothing.
class KnownPlaces {
 public:
  /// The calibration in use (geometry::Rig::id()). @returns how many places were dropped because
  /// they were measured with another one.
  std::size_t useRig(const std::string& rig_id);

  void add(const KnownPlace& place) { places_.push_back(place); }

  /// Drops the latest. @returns false when there is none.
  bool undo();

  void clear() { places_.clear(); }

  const std::vector<KnownPlace>& places() const { return places_; }
  const std::string& rigId() const { return rig_id_; }

 private:
  std::string rig_id_;
  std::vector<KnownPlace> places_;
};

}  // namespace wiimote_tracker::place

#endif  // WIIMOTE_TRACKER_CALIBRATION_PLACE_KNOWN_PLACES_H
