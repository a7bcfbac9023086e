#pragma once

#include "motion/pixel_prediction.h"
#include "ray_agreement.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

namespace wiimote_tracker::tracking {

/// A camera of the rig with precomputed properties of its view.
class TrackerCamera {
 public:
  TrackerCamera(const geometry::Rig& rig,
                const geometry::RigCamera& camera,
                const TrackerOptions& options)
      : pixel_stddev_(geometry::pixelNoise(camera, options.learnt_noise, options.pixel_stddev)),
        // Rays also miss each other by errors of calibration and time, however exact the spots are.
        ray_stddev_(std::max(pixel_stddev_, options.pixel_stddev)),
        masks_(camera.masks),
        for_rays_(rig.rayCamera(camera)),
        squared_cosine_(squaredCosineOfView(for_rays_.intrinsics)) {}

  const geometry::Camera& forRays() const { return for_rays_; }

  /// Of an image's pixels. @param stamp_stddev [s]
  geometry::PixelNoise noise(double stamp_stddev) const { return {pixel_stddev_, stamp_stddev}; }

  /// [px^2]
  double imageArea() const {
    return static_cast<double>(for_rays_.intrinsics.width) * for_rays_.intrinsics.height;
  }

  /// A cheap test: whether a point [m] is within the cone that encloses the view.
  bool mayShow(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d sight = point - for_rays_.center();
    const double depth = for_rays_.world_from_camera.linear().col(2).dot(sight);
    return depth > 0.0 && depth * depth >= squared_cosine_ * sight.squaredNorm();
  }

  /// The ray of a spot, as of a pinhole. @param led [m] @param residual of its spot [px]
  RayOffset rayOffset(const Eigen::Vector3d& led, const Eigen::Vector2d& residual) const {
    const Eigen::Vector3d sight = led - for_rays_.center();
    const geometry::Intrinsics& lens = for_rays_.intrinsics;
    const Eigen::Matrix3d& axes = for_rays_.world_from_camera.linear();
    const double depth = axes.col(2).dot(sight);
    RayOffset result;
    result.direction = sight.normalized();
    result.offset =
        depth * (residual.x() / lens.fx * axes.col(0) + residual.y() / lens.fy * axes.col(1));
    result.scale = depth / lens.fx;
    result.pixel_stddev = ray_stddev_;
    return result;
  }

  /// Whether the pixel is at most `margin` [px] outside the image.
  bool isInImage(const Eigen::Vector2d& pixel, double margin) const {
    return for_rays_.intrinsics.isInImage(pixel, margin);
  }
  bool isMasked(const Eigen::Vector2d& pixel) const { return geometry::isMasked(masks_, pixel); }

 private:
  static double squaredCosineOfView(const geometry::Intrinsics& lens) {
    constexpr double kMargin = 0.1;  // [rad]
    double widest = 0.0;
    for (const double u : {0.0, lens.width - 1.0}) {
      for (const double v : {0.0, lens.height - 1.0}) {
        const auto corner = lens.normalizedFromPixel({u, v});
        if (!corner)
          return 0.0;
        widest = std::max(widest, std::atan(corner->norm()));
      }
    }
    const double cosine = std::cos(std::min(widest + kMargin, 0.5 * M_PI));
    return cosine * cosine;
  }

  double pixel_stddev_;  // [px]
  double ray_stddev_;    // [px]
  std::vector<geometry::ImageMask> masks_;
  geometry::Camera for_rays_;
  double squared_cosine_;  // of the cone around the view; 0: no limit
};

}  // namespace wiimote_tracker::tracking
