#ifndef WIIMOTE_TRACKER_TRIANGULATION_TRACKING_ESTIMATOR_H
#define WIIMOTE_TRACKER_TRIANGULATION_TRACKING_ESTIMATOR_H

#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/camera_image.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <cstddef>
#include <cstdint>

namespace wiimote_tracker::tracking {

/// Counted since the estimator began.
struct Counters {
  /// Images older than one of the same or another camera that was already used: put in at their
  /// time where the estimator can, and counted.
  std::uint64_t late = 0;
  std::uint64_t dropped = 0;     ///< Images too old for any use.
  std::uint64_t repeated = 0;    ///< Images that had been there before.
  std::uint64_t disordered = 0;  ///< Images added after one that arrived later.
  std::uint64_t resets = 0;      ///< Times that all was forgotten because time jumped back.
};

/// From the images of a rig's cameras to LEDs. Two kinds: per instant (fusion::InstantFuser, the
/// paper's way) and tracks in continuous time (tracking::Tracker). The result is a function of the
/// rig, the options and the sequence of images added; no clock is read. Does not allocate once
/// warm.
class Estimator {
 public:
  virtual ~Estimator() = default;

  /// Takes effect with the next image, all cameras at once. Time goes on: there is no snapshot at
  /// or before the last one, and no id is used again.
  /// @throws geometry::InvalidRigError (see Rig::check); then the rig before stays.
  virtual void setRig(const geometry::Rig& rig) = 0;

  /// Adds an image of the camera at `camera` in the rig. Its pixels must be finite.
  virtual void add(std::size_t camera, const CameraImage& image) = 0;

  /// The next snapshot that is due, in strictly increasing time; null when there is none. Valid
  /// until the next call. Call after each add(), until it is null.
  virtual const Snapshot* next() = 0;

  virtual const Counters& counters() const = 0;

  /// Writes all LEDs at a time [s] to which no image has come yet: for output at a fixed rate, and
  /// for what is now. False, and nothing is written: the estimator can not, has seen no image, or
  /// has gone beyond that time.
  virtual bool predictTo(double /*time*/, Snapshot* /*snapshot*/) const { return false; }
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_TRACKING_ESTIMATOR_H
