#include "tracker_camera.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::tracking {
namespace {

constexpr double kConeMargin = 0.1;  // [rad]

double squaredCosineOfView(const geometry::Intrinsics& lens) {
  double widest = 0.0;
  for (const double u : {0.0, lens.width - 1.0}) {
    for (const double v : {0.0, lens.height - 1.0}) {
      const auto corner = lens.normalizedFromPixel({u, v});
      if (!corner)
        return 0.0;
      widest = std::max(widest, std::atan(corner->norm()));
    }
  }
  const double cosine = std::cos(std::min(widest + kConeMargin, 0.5 * M_PI));
  return cosine * cosine;
}

}  // namespace

TrackerCamera::TrackerCamera(const geometry::Rig& rig,
                             const geometry::RigCamera& camera,
                             const TrackerOptions& options)
    : pixel_stddev_(geometry::pixelNoise(camera, options.learnt_noise, options.pixel_stddev)),
      // Rays also miss each other by errors of calibration and time, however exact the spots are.
      ray_stddev_(std::max(pixel_stddev_, options.pixel_stddev)),
      masks_(camera.masks),
      for_rays_(rig.rayCamera(camera)),
      squared_cosine_(squaredCosineOfView(for_rays_.intrinsics)) {}

double TrackerCamera::imageArea() const {
  return static_cast<double>(for_rays_.intrinsics.width) * for_rays_.intrinsics.height;
}

bool TrackerCamera::mayShow(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d sight = point - for_rays_.center();
  const double depth = for_rays_.world_from_camera.linear().col(2).dot(sight);
  return depth > 0.0 && depth * depth >= squared_cosine_ * sight.squaredNorm();
}

RayOffset TrackerCamera::rayOffset(const Eigen::Vector3d& led,
                                   const Eigen::Vector2d& residual) const {
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

}  // namespace wiimote_tracker::tracking
