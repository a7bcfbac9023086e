#ifndef WIIMOTE_TRACKER_TRIANGULATION_FUSION_INSTANT_FUSER_H
#define WIIMOTE_TRACKER_TRIANGULATION_FUSION_INSTANT_FUSER_H

#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"
#include "wiimote_tracker_triangulation/tracking/estimator.h"

#include <cstddef>
#include <memory>

namespace wiimote_tracker::fusion {

struct InstantFuserOptions {
  geometry::TriangulationOptions triangulation;

  /// A camera whose newest image arrived longer ago than this is not waited for [s, > 0].
  double camera_timeout = 0.1;

  /// A camera's pixel is interpolated between two images no further apart than this [s, > 0].
  /// At most camera_timeout.
  double maximum_gap = 0.05;

  /// A spot moves no faster than this from one image to the next [px/s, > 0].
  double maximum_spot_speed = 5000.0;

  /// A point that fits its pixels worse than this is no LED [px, > 0]. Spots are associated with a
  /// fifth of it as the standard deviation of a pixel.
  double maximum_reprojection_error = 20.0;

  std::size_t minimum_rays = 2;  ///< Of a point [>= 2].

  /// Cameras see LEDs no further than this [m, > 0]; those that share no view up to there are not
  /// associated.
  double maximum_range = 15.0;

  std::size_t maximum_leds = 4;   ///< At any time [>= 1].
  std::size_t confirmations = 3;  ///< An LED seen in fewer instants is tentative [>= 1].

  /// An LED is the same one as before when it moved no faster than this [m/s, > 0] ...
  double maximum_speed = 5.0;

  /// ... and was absent no longer than this [s, >= 0].
  double maximum_absence = 0.5;
};

/// Brings the spots of cameras that are not synchronised to one time each, finds out which belong
/// together, and intersects their rays, as the paper does.
///
/// Every image's time is an instant. Its snapshot is emitted once, as soon as every active camera
/// has reached it; each spot is interpolated between the images around it. A camera is active while
/// its newest image arrived within camera_timeout of the newest arrival of all; at the start each
/// camera is given that long. Thus a blind camera contributes no ray, a dead one delays things once
/// by camera_timeout, and one that comes back is used again.
///
/// Each spot is followed from image to image (followSpots). The spots of an instant are associated
/// over all cameras anew (association::ViewAssociator); a spot that fits to no point enters none.
/// When a point does not fit its pixels and has more than two rays, the one without which the
/// others agree best is left out; when they still do not agree, there is no point. A point is the
/// LED of an instant before that is nearest. An LED without a point is in no snapshot until it is
/// lost. A spot of a view is where it was at the time of the snapshot; masked ones where they were
/// last.
///
/// The snapshots depend on the images only, not on the order in which those of different cameras
/// are added, as long as each camera's own images are added in the order of their times, every
/// camera is heard at least once per camera_timeout, and no image is added after another one that
/// arrived more than camera_timeout later. Adding images in the order of arrival always gives the
/// same.
///
/// Counters: an image that is not newer than that camera's newest is not used (dropped, and late or
/// repeated); one older than a snapshot already emitted is of use for the next ones only (late).
class InstantFuser : public tracking::Estimator {
 public:
  /// An arrival so much earlier than the one before of the same camera is a bag that starts over:
  /// all is forgotten [s].
  static constexpr double kJump = 1.0;

  /// @throws geometry::InvalidRigError (see Rig::check).
  InstantFuser(const geometry::Rig& rig, const InstantFuserOptions& options);
  ~InstantFuser() override;

  void setRig(const geometry::Rig& rig) override;
  void add(std::size_t camera, const tracking::CameraImage& image) override;
  const tracking::Snapshot* next() override;
  const tracking::Counters& counters() const override { return counters_; }

 private:
  struct Parts;

  std::unique_ptr<Parts> parts_;
  tracking::Counters counters_;
};

}  // namespace wiimote_tracker::fusion

#endif  // WIIMOTE_TRACKER_TRIANGULATION_FUSION_INSTANT_FUSER_H
