#ifndef WIIMOTE_TRACKER_TRIANGULATION_FUSION_INSTANT_FUSER_H
#define WIIMOTE_TRACKER_TRIANGULATION_FUSION_INSTANT_FUSER_H

#include "wiimote_tracker_triangulation/fusion/frame_history.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace wiimote_tracker::fusion {

struct InstantFuserOptions {
  geometry::TriangulationOptions triangulation;

  /// A camera whose newest image arrived longer ago than this is not waited for [s, > 0].
  double camera_timeout = 0.1;

  /// A camera's pixel is interpolated between two images no further apart than this [s, > 0].
  /// At most camera_timeout.
  double maximum_gap = 0.05;

  /// A point that fits its pixels worse than this is not the LED [px, > 0].
  double maximum_reprojection_error = 20.0;
};

/// An image as it comes from a camera.
struct CameraImage {
  double stamp = 0.0;                   ///< Of the exposure, without the rig's time offset [s].
  double arrival = 0.0;                 ///< When it reached the computer [s].
  std::uint32_t clock_epoch = 0;        ///< As in IrBlobArray.msg.
  std::vector<Eigen::Vector2d> pixels;  ///< All spots, distorted [px].
};

/// What one camera contributes to an instant.
struct Sighting {
  std::optional<Eigen::Vector2d> pixel;  ///< At the instant, distorted [px].
  bool used = false;                     ///< Its ray entered the point.
};

/// One LED at one time, from all cameras.
struct Instant {
  double time = 0.0;                ///< [s]
  double latest_arrival = 0.0;      ///< Of the newest image that was looked at, dark ones too [s].
  double skew = 0.0;                ///< Largest distance from time to an image looked at [s].
  std::vector<Sighting> sightings;  ///< One per camera, in the order of the rig.

  /// Nothing when the LED was not seen, or not by two cameras that agree. What follows is only
  /// meaningful with a point.
  std::optional<geometry::TriangulatedPoint> point;
  std::size_t rays_used = 0;
  std::size_t rays_possible = 0;  ///< Cameras that have the point in view, or used it.
  double last_observed = 0.0;     ///< Newest image not after time that shows the LED [s].
};

/// Brings the spots of cameras that are not synchronised to one time each and intersects the rays,
/// as the paper does, for one LED.
///
/// Every image's time is an instant. It is emitted once, as soon as every active camera has reached
/// it; each camera's pixel is interpolated between the images around it. A camera is active while
/// its newest image arrived within camera_timeout of the newest arrival of all; at the start each
/// camera is given that long. Thus a blind camera contributes no ray, a dead one delays things once
/// by camera_timeout, and one that comes back is used again. An image with several spots counts as
/// blind, since there is one LED.
///
/// The instants depend on the images only, not on the order in which those of different cameras are
/// added, as long as each camera's own images are added in the order of their times, every camera
/// is heard at least once per camera_timeout, and no image is added after another one that arrived
/// more than camera_timeout later. Adding images in the order of arrival always gives the same.
///
/// Does not allocate once warm.
class InstantFuser {
 public:
  /// @throws geometry::InvalidRigError (see Rig::check).
  InstantFuser(const geometry::Rig& rig, const InstantFuserOptions& options);
  InstantFuser(const InstantFuser&) = delete;
  InstantFuser& operator=(const InstantFuser&) = delete;

  /// Adds an image of the camera at `camera` in the rig.
  void add(std::size_t camera, const CameraImage& image);

  /// The next instant that is due, in strictly increasing time; null when there is none. Valid
  /// until the next call. Call after each add(), until it is null.
  const Instant* next();

  /// Images that came too late: not newer than that camera's newest (then ignored), or older than
  /// an instant already emitted (then of use for the next one only).
  std::uint64_t lateFrames() const { return late_frames_; }

  /// How often time jumped back by more than kJump (a bag that starts over) and all was forgotten.
  std::uint64_t resets() const { return resets_; }

  /// Emit nothing at or before this time [s]; count late images on from there.
  void continueFrom(double time, std::uint64_t late_frames);

  static constexpr double kJump = 1.0;  ///< [s]

 private:
  struct CameraState {
    geometry::Camera real;     // for what is in view
    geometry::Camera for_ray;  // for rays (see Rig::rayCamera)
    const geometry::RigCamera* calibration;
    FrameHistory frames;
  };

  void reset(double arrival);
  Frame frameOf(const CameraState& camera, const CameraImage& image) const;
  double reachedByAll() const;
  void collectSightings();
  void locate();
  bool fits(const std::optional<geometry::TriangulatedPoint>& point) const;
  void dropWorst();
  void countRays();

  geometry::Rig rig_;
  InstantFuserOptions options_;
  std::vector<CameraState> cameras_;
  bool started_ = false;
  double started_at_ = 0.0;      // arrival of the first image
  double newest_arrival_ = 0.0;  // of all cameras
  double newest_time_ = 0.0;     // of all cameras
  double emitted_until_ = -std::numeric_limits<double>::infinity();
  std::uint64_t late_frames_ = 0;
  std::uint64_t resets_ = 0;
  Instant instant_;
  std::vector<geometry::Observation> observations_;  // parallel to observers_
  std::vector<geometry::Observation> subset_;
  std::vector<std::size_t> observers_;  // cameras of observations_
};

}  // namespace wiimote_tracker::fusion

#endif  // WIIMOTE_TRACKER_TRIANGULATION_FUSION_INSTANT_FUSER_H
