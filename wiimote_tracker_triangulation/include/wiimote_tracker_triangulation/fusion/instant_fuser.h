#pragma once

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

  /// Points with a larger reprojection error are refused [px, > 0]. A fifth of it is the standard
  /// deviation of a pixel in the association.
  double maximum_reprojection_error = 20.0;

  std::size_t minimum_rays = 2;  ///< Of a point [>= 2].

  /// Greatest distance of an LED from a camera [m, > 0]. Cameras whose views do not overlap within
  /// it are not associated.
  double maximum_range = 15.0;

  std::size_t maximum_leds = 4;   ///< At one time [>= 1].
  std::size_t confirmations = 3;  ///< An LED seen in fewer instants is tentative [>= 1].
  double maximum_speed = 5.0;     ///< Of an LED, for the gate of its id [m/s, > 0].
  double maximum_absence = 0.5;   ///< An LED that is absent for longer is lost [s, >= 0].
};

/// Interpolates the spots of unsynchronised cameras to common instants, associates them and
/// intersects their rays, as the paper does.
///
/// Every image's time is an instant. Its snapshot is emitted as soon as every active camera has
/// reached it. A camera is active while its newest image arrived within camera_timeout of the
/// newest arrival of all cameras. So a camera that sees nothing contributes no ray, one that fails
/// delays the snapshots once by camera_timeout, and one that comes back is used again.
///
/// Each spot is followed from image to image (followSpots) and interpolated. The spots of each
/// instant are associated anew (association::ViewAssociator). If the reprojection error of a point
/// is too large and it has more than two rays, the worst ray is left out; if it still is too large,
/// there is no point. A point belongs to the nearest LED of the instants before. An LED without a
/// point is in no snapshot until it is lost. Spots in the snapshot's views are interpolated; masked
/// ones are those of the last image.
///
/// The snapshots do not depend on the order in which images of different cameras are added, as long
/// as each camera's images are added in the order of their times, each camera sends within
/// camera_timeout, and no image is added after one that arrived more than camera_timeout later.
///
/// Counters: an image that is not newer than its camera's newest is not used (dropped, and late or
/// repeated); one older than the last snapshot is used for later snapshots only (late).
class InstantFuser : public tracking::Estimator {
 public:
  /// All state is forgotten when a camera's image arrives this much earlier than its last one, as
  /// when a bag restarts [s]; or, after setRig(), when all images are this much earlier than
  /// before.
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
