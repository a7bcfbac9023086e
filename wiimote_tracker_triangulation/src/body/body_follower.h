#ifndef WIIMOTE_TRACKER_TRIANGULATION_BODY_BODY_FOLLOWER_H
#define WIIMOTE_TRACKER_TRIANGULATION_BODY_BODY_FOLLOWER_H

#include "tracking/time_watch.h"
#include "wiimote_tracker_triangulation/body/body_tracker.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/camera_image.h"

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace wiimote_tracker::body {

/// The bodies at the time of an image.
struct BodySnapshot {
  double time = 0.0;            ///< [s]
  double latest_arrival = 0.0;  ///< Of the newest image [s].

  /// One per constellation; nothing while it is not known where the body is.
  std::vector<std::optional<BodyEstimate>> bodies;

  /// Indices of bodies that are no more followed since the snapshot before, of which `bodies` has
  /// the last estimate for once.
  std::vector<std::size_t> lost;
};

/// Stands between the cameras and whoever follows free LEDs: looks for bodies in each image, and
/// takes their spots out of it. A function of the sequence of calls; does not allocate once warm.
class BodyFollower {
 public:
  explicit BodyFollower(const BodyTrackerOptions& options) : options_(options) {}

  /// Bodies are found anew before the new cameras. @throws geometry::InvalidRigError (see
  /// Rig::check); then the rig before stays.
  void setRig(const geometry::Rig& rig);

  /// The bodies to be followed from now on; those that were followed already are found anew.
  /// @throws Error (Constellation::check); then those before stay.
  void setBodies(const std::vector<Constellation>& constellations);

  const std::vector<Constellation>& constellations() const { return constellations_; }

  /// Takes an image in, and the spots of bodies out of it. Only with a rig.
  void take(std::size_t camera, tracking::CameraImage* image);

  /// See BodyTracker; the points are of the newest snapshot's time.
  void startFromLabels(const std::vector<LabelledPoint>& points);

  /// What the last image has brought, when it is newer than all before and there are bodies to be
  /// followed; else null. Valid until the next call.
  const BodySnapshot* next();

 private:
  void useTracker(const geometry::Rig& rig, const std::vector<Constellation>& constellations);

  BodyTrackerOptions options_;
  geometry::Rig rig_;
  std::vector<Constellation> constellations_;
  std::unique_ptr<BodyTracker> tracker_;  // only with a rig and constellations
  std::unique_ptr<tracking::TimeWatch> time_watch_;
  double latest_arrival_ = 0.0;  // [s]
  double last_output_ = -std::numeric_limits<double>::infinity();
  BodySnapshot snapshot_;

  // Reused.
  std::vector<Eigen::Vector2d> pixels_;
  std::vector<std::size_t> spots_;  // of the image, that the pixels are of
  std::vector<bool> is_taken_;      // of the image's spots
};

}  // namespace wiimote_tracker::body

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BODY_BODY_FOLLOWER_H
