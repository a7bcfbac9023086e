#ifndef WIIMOTE_TRACKER_TRIANGULATION_BODY_BODY_FOLLOWER_H
#define WIIMOTE_TRACKER_TRIANGULATION_BODY_BODY_FOLLOWER_H

#include "tracking/arrival_clocks.h"
#include "wiimote_tracker_triangulation/body/body_tracker.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/camera_image.h"
#include "wiimote_tracker_triangulation/tracking/estimator.h"

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace wiimote_tracker::body {

/// The bodies at the time of an image.
struct BodySnapshot {
  double time = 0.0;            ///< [s]
  double latest_arrival = 0.0;  ///< Of the newest image [s].

  /// One per constellation; nothing while the body's pose is unknown. A body that was lost since
  /// the snapshot before is there once more.
  std::vector<std::optional<BodyEstimate>> bodies;
};

/// Tracks bodies in each image and removes their spots from it, before the image goes to the
/// tracking of free LEDs. The result depends on the sequence of calls only; does not allocate once
/// warm.
class BodyFollower {
 public:
  explicit BodyFollower(const BodyTrackerOptions& options) : options_(options) {}

  /// See BodyTracker; where a time offset jumps, bodies are searched anew.
  /// @throws geometry::InvalidRigError (see Rig::check); the previous rig then stays.
  void setRig(const geometry::Rig& rig);

  /// Sets the bodies to track. Those that were tracked before, with the same constellation, go on.
  /// @returns the latest snapshot of the bodies before: those that do not go on, as lost.
  /// @throws Error (Constellation::check); the previous bodies then stay.
  BodySnapshot setBodies(const std::vector<Constellation>& constellations);

  const std::vector<Constellation>& constellations() const { return constellations_; }

  /// Tracks bodies in an image and removes their spots from it. Requires a rig.
  /// @param clock see Estimator::clockError(). @param is_doubtful see Estimator::isDoubtful().
  void take(std::size_t camera,
            const tracking::ClockError& clock,
            tracking::CameraImage* image,
            bool is_doubtful = false);

  /// See BodyTracker.
  void addInertial(std::size_t body, const InertialSample& sample);

  /// See BodyTracker. The points are of the newest snapshot's time.
  void startFromLabels(const std::vector<LabelledPoint>& points);

  /// The snapshot after the last image if it is newer than all before, else null. Valid until the
  /// next call.
  const BodySnapshot* next();

 private:
  BodyTrackerOptions options_;
  geometry::Rig rig_;
  std::vector<Constellation> constellations_;
  // With a rig:
  std::optional<BodyTracker> tracker_;
  std::optional<tracking::ArrivalClocks> arrival_clocks_;
  double latest_arrival_ = 0.0;  // [s]
  double last_output_ = -std::numeric_limits<double>::infinity();
  BodySnapshot snapshot_;

  std::vector<Eigen::Vector2d> pixels_;  // reused
};

}  // namespace wiimote_tracker::body

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BODY_BODY_FOLLOWER_H
