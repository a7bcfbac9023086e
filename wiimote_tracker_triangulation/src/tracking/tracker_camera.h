#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_TRACKER_CAMERA_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_TRACKER_CAMERA_H

#include "motion/pixel_prediction.h"
#include "ray_agreement.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <Eigen/Core>

#include <vector>

namespace wiimote_tracker::tracking {

/// A camera of the rig with precomputed properties of its view.
class TrackerCamera {
 public:
  TrackerCamera(const geometry::Rig& rig,
                const geometry::RigCamera& camera,
                const TrackerOptions& options);

  const geometry::Camera& forRays() const { return for_rays_; }

  /// Of an image's pixels. @param stamp_stddev [s]
  geometry::PixelNoise noise(double stamp_stddev) const { return {pixel_stddev_, stamp_stddev}; }

  double imageArea() const;  ///< [px^2]

  /// A cheap test: whether a point [m] is within the cone that encloses the view.
  bool mayShow(const Eigen::Vector3d& point) const;

  /// The ray of a spot, as of a pinhole. @param led [m] @param residual of its spot [px]
  RayOffset rayOffset(const Eigen::Vector3d& led, const Eigen::Vector2d& residual) const;

  /// Whether the pixel is at most `margin` [px] outside the image.
  bool isInImage(const Eigen::Vector2d& pixel, double margin) const {
    return for_rays_.intrinsics.isInImage(pixel, margin);
  }
  bool isMasked(const Eigen::Vector2d& pixel) const { return geometry::isMasked(masks_, pixel); }

 private:
  double pixel_stddev_;  // [px]
  double ray_stddev_;    // [px]
  std::vector<geometry::ImageMask> masks_;
  geometry::Camera for_rays_;
  double squared_cosine_;  // of the cone around the view; 0: no limit
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_TRACKER_CAMERA_H
