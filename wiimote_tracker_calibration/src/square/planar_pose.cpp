#include "square/planar_pose.h"

#include "adjust/opencv.h"
#include "adjust/pixel.h"
#include "adjust/solver.h"

#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <ceres/problem.h>

#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace wiimote_tracker::square {

namespace {

constexpr double kSameAngle = 3.5e-4;   // [rad]
constexpr double kSameDistance = 2e-4;  // [1]
// Displacement of one corner in the image plane at depth 1 for a second try: OpenCV's IPPE returns
// NaN, the root of a negative rounding error, where the camera is not tilted, or only about an axis
// of the square.
constexpr double kNudge = 1e-4;

/// The corners that a camera saw.
struct SeenCorners {
  std::vector<Eigen::Vector2d> pixels;
  std::vector<Eigen::Vector3d> places;
};

/// Whether three of the points, of third coordinate 1, are on one line or two in one place.
bool isDegenerate(const std::vector<Eigen::Vector3d>& points) {
  const std::size_t count = points.size();
  double extent = 0.0;
  for (std::size_t i = 1; i < count; ++i)
    extent = std::max(extent, (points[i] - points[0]).squaredNorm());
  for (std::size_t i = 0; i < count; ++i) {
    const double area = points[i].dot(points[(i + 1) % count].cross(points[(i + 2) % count]));
    if (!(std::abs(area) > 1e-9 * extent))
      return true;
  }
  return false;
}

bool isInFront(const std::vector<Eigen::Vector3d>& places,
               const Eigen::Isometry3d& world_from_camera) {
  return std::all_of(places.begin(), places.end(), [&](const Eigen::Vector3d& place) {
    return (world_from_camera.inverse() * place).z() > 1e-6;
  });
}

/// Poses in closed form, with all corners in front of the camera.
std::vector<Eigen::Isometry3d> startPoses(const geometry::Intrinsics& intrinsics,
                                          const SeenCorners& seen) {
  std::vector<Eigen::Vector3d> normalized;
  std::vector<cv::Point2d> image;
  std::vector<cv::Point3d> plane;
  for (std::size_t i = 0; i < seen.pixels.size(); ++i) {
    const auto undistorted = intrinsics.normalizedFromPixel(seen.pixels[i]);
    if (!undistorted)
      return {};
    normalized.push_back(undistorted->homogeneous());
    image.emplace_back(undistorted->x(), undistorted->y());
    // Already in the plane z = 0: OpenCV's IPPE fails where it has to rotate the plane itself.
    plane.emplace_back(seen.places[i].x(), seen.places[i].y(), 0.0);
  }
  if (isDegenerate(normalized))
    return {};
  std::vector<Eigen::Isometry3d> poses;
  for (const double nudge : {0.0, kNudge}) {
    image.front().x += nudge;
    const cv::Mat pinhole = cv::Mat::eye(3, 3, CV_64F);
    std::vector<cv::Mat> rotations;
    std::vector<cv::Mat> translations;
    if (image.size() == 3)
      cv::solveP3P(plane, image, pinhole, cv::noArray(), rotations, translations,
                   cv::SOLVEPNP_AP3P);
    else
      cv::solvePnPGeneric(plane, image, pinhole, cv::noArray(), rotations, translations, false,
                          cv::SOLVEPNP_IPPE);
    for (std::size_t i = 0; i < rotations.size(); ++i) {
      Eigen::Isometry3d pose = adjust::poseFromCv(rotations[i], translations[i]).inverse();
      pose.translation().z() += seen.places.front().z();
      if (isInFront(seen.places, pose))
        poses.push_back(pose);
    }
    if (!poses.empty())
      break;
  }
  return poses;
}

/// The pose of least reprojection error near that of the camera. Nothing when the lens has no pixel
/// of a corner there.
std::optional<PlanarPose> refined(geometry::Camera camera, const SeenCorners& seen) {
  adjust::CameraBlocks blocks(camera);
  std::vector<Eigen::Vector3d> places = seen.places;
  ceres::Problem problem;
  for (std::size_t i = 0; i < places.size(); ++i) {
    blocks.addTo(&problem, adjust::PixelError(blocks, seen.pixels[i], 1.0).cost(), nullptr,
                 places[i].data());
    problem.SetParameterBlockConstant(places[i].data());
  }
  problem.SetParameterBlockConstant(blocks.lens());
  problem.SetParameterBlockConstant(blocks.higherDistortion());
  // Near the view from straight above, where the two branches meet, it converges slowly.
  const ceres::Solver::Summary summary = adjust::minimise(
      adjust::solverOptions(ceres::DENSE_QR, 200, {1e-14, 1e-12, 1e-14}), &problem);
  if (!summary.IsSolutionUsable() || !std::isfinite(summary.final_cost))
    return std::nullopt;
  camera = blocks.cameraLike(camera);
  for (const Eigen::Vector3d& place : places) {
    if (!camera.project(place))
      return std::nullopt;
  }
  return PlanarPose{camera.world_from_camera, 2.0 * summary.final_cost};
}

}  // namespace

PlanarPoses cornerPoses(const geometry::Intrinsics& intrinsics,
                        const std::array<std::optional<Eigen::Vector2d>, 4>& pixels,
                        const Corners& corners) {
  SeenCorners seen;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    if (!pixels[c])
      continue;
    seen.pixels.push_back(*pixels[c]);
    seen.places.push_back(corners[c]);
  }
  PlanarPoses poses;
  geometry::Camera camera;
  camera.intrinsics = intrinsics;
  for (const Eigen::Isometry3d& start : startPoses(intrinsics, seen)) {
    camera.world_from_camera = start;
    const auto found = refined(camera, seen);
    const bool known =
        found && std::any_of(poses.begin(), poses.end(), [&](const PlanarPose& other) {
          return isSamePose(other.world_from_camera, found->world_from_camera, corners);
        });
    if (found && !known)
      poses.push_back(*found);
  }
  std::sort(poses.begin(), poses.end(),
            [](const PlanarPose& a, const PlanarPose& b) { return a.cost < b.cost; });
  return poses;
}

bool isSamePose(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, const Corners& corners) {
  const double distance = (a.translation() - 0.5 * (corners[0] + corners[2])).norm();
  return geometry::so3::angleBetween(a.linear(), b.linear()) < kSameAngle &&
         (a.translation() - b.translation()).norm() < kSameDistance * distance;
}

}  // namespace wiimote_tracker::square
