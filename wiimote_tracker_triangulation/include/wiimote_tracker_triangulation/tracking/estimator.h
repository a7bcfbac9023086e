#pragma once

#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/camera_image.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <cstddef>
#include <cstdint>
#include <optional>

namespace wiimote_tracker::tracking {

/// Totals since the estimator was made.
struct Counters {
  std::uint64_t late = 0;        ///< Images older than one that was used, or in its place.
  std::uint64_t dropped = 0;     ///< Images that could not be used.
  std::uint64_t repeated = 0;    ///< Images that were added before.
  std::uint64_t disordered = 0;  ///< Images added after one that arrived later.
  std::uint64_t resets = 0;      ///< Resets because time jumped back.
};

/// What is wrong with a camera, by the images of all.
struct CameraFault {
  enum class Kind {
    kWrongClock,      ///< Its images are left out.
    kLate,            ///< Its images are older than the history, and are left out.
    kCorrectedClock,  ///< The times of its images are corrected.
    kMisfit,          ///< Its spots are not where others see LEDs or bodies; it is left out.
    kInaccurate,      ///< The same, by no more than errors of the calibration explain.
  };
  Kind kind;

  /// How far its clock is ahead of most cameras' [s]; NaN if no group of clocks is the largest. Of
  /// kLate: the time of its last image less that of the newest of all.
  double clock_ahead;
};

/// What motion has shown of a camera's clock, beside the rig's time offset.
struct ClockError {
  double offset = 0.0;    ///< By how much its stamps are too late [s].
  double variance = 0.0;  ///< [s^2]
};

/// Estimates LEDs from the images of a rig's cameras: per instant (fusion::InstantFuser, the
/// paper's method) or as tracks in continuous time (tracking::Tracker). The result is a function of
/// the rig, the options and the sequence of images; no clock is read. Does not allocate once warm.
class Estimator {
 public:
  virtual ~Estimator() = default;

  /// Takes effect with the next image. Snapshots stay in increasing time, and no id is used again.
  /// @throws geometry::InvalidRigError (see Rig::check); then the old rig stays.
  virtual void setRig(const geometry::Rig& rig) = 0;

  /// Adds an image of the camera at `camera` in the rig. Its pixels must be finite.
  virtual void add(std::size_t camera, const CameraImage& image) = 0;

  /// The next snapshot that is due, in strictly increasing time; null when there is none. Valid
  /// until the next call. Call after each add(), until it is null.
  virtual const Snapshot* next() = 0;

  virtual const Counters& counters() const = 0;

  /// What is wrong with a camera at present.
  virtual std::optional<CameraFault> cameraFault(std::size_t /*camera*/) const {
    return std::nullopt;
  }

  /// Whether a camera does not fit the others (kMisfit, kInaccurate), or it and its only other one
  /// do not: then no LED and no body is located by its images.
  virtual bool isDoubtful(std::size_t /*camera*/) const { return false; }

  /// Of a camera's clock in one of its epochs.
  virtual ClockError clockError(std::size_t /*camera*/, std::uint32_t /*clock_epoch*/) const {
    return {};
  }

  /// Predicts all LEDs to a time [s] not before the newest image, for output at a fixed rate.
  /// False, and nothing is written, when the estimator cannot predict, has seen no image or is past
  /// that time.
  virtual bool predictTo(double /*time*/, Snapshot* /*snapshot*/) { return false; }
};

}  // namespace wiimote_tracker::tracking
