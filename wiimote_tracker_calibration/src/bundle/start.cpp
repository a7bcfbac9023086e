#include "start.h"

#include "adjust/opencv.h"

#include <Eigen/Geometry>

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/core/eigen.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>

namespace wiimote_tracker::bundle {

namespace {

double focalLength(const geometry::Camera& camera) {
  return 0.5 * (camera.intrinsics.fx + camera.intrinsics.fy);
}

}  // namespace

Reconstruction thinned(const Reconstruction& all, std::size_t enough) {
  std::vector<std::vector<const Observation*>> views(all.points.size());
  for (const Observation& observation : all.observations)
    views[observation.point].push_back(&observation);
  std::mt19937 random(1);
  for (std::size_t i = views.size(); i > 1; --i)
    std::swap(views[i - 1], views[random() % i]);
  std::stable_sort(views.begin(), views.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  Reconstruction few;
  few.cameras = all.cameras;
  const std::size_t cameras = all.cameras.size();
  std::vector<std::vector<std::size_t>> common(cameras, std::vector<std::size_t>(cameras, 0));
  for (const std::vector<const Observation*>& point : views) {
    bool is_wanted = false;
    for (const Observation* a : point) {
      for (const Observation* b : point)
        is_wanted = is_wanted || (a != b && common[a->camera][b->camera] < enough);
    }
    if (!is_wanted)
      continue;
    for (const Observation* a : point) {
      for (const Observation* b : point)
        ++common[a->camera][b->camera];
      few.observations.push_back({a->camera, few.points.size(), a->pixel});
    }
    few.points.emplace_back();
  }
  few.inliers.assign(few.observations.size(), false);
  return few;
}

NormalizedViews normalize(const Reconstruction& reconstruction) {
  NormalizedViews views(reconstruction.cameras.size());
  for (const Observation& observation : reconstruction.observations) {
    const geometry::Intrinsics& intrinsics = reconstruction.cameras[observation.camera].intrinsics;
    if (const auto normalized = intrinsics.normalizedFromPixel(observation.pixel))
      views[observation.camera][observation.point] = *normalized;
  }
  return views;
}

CommonViews commonViews(const std::map<std::size_t, Eigen::Vector2d>& first,
                        const std::map<std::size_t, Eigen::Vector2d>& second) {
  CommonViews common;
  for (const auto& [point, view] : first) {
    const auto other = second.find(point);
    if (other == second.end())
      continue;
    common.first.emplace_back(view.x(), view.y());
    common.second.emplace_back(other->second.x(), other->second.y());
  }
  return common;
}

double distanceFromPlane(const CommonViews& common, double tolerance) {
  const int kIterations = 200;
  const double kFarthest = 10.0;
  cv::Mat mask;
  const cv::Mat homography = cv::findHomography(common.first, common.second, cv::RANSAC, tolerance,
                                                mask, kIterations, 0.99);
  if (homography.empty())
    return 0.0;
  std::vector<cv::Point2d> mapped;
  cv::perspectiveTransform(common.first, mapped, homography);
  double sum = 0.0;
  for (std::size_t i = 0; i < mapped.size(); ++i)
    sum += std::min(cv::norm(mapped[i] - common.second[i]), kFarthest * tolerance);
  return sum / static_cast<double>(mapped.size());
}

std::vector<CameraPair> likelyPairs(const Reconstruction& observed, const Options& options) {
  // Number of points that suffices for the pose of a camera.
  const double kEnough = 60.0;
  std::vector<std::map<std::size_t, Eigen::Vector2d>> views(observed.cameras.size());
  for (const Observation& observation : observed.observations)
    views[observation.camera][observation.point] = observation.pixel;
  std::vector<std::pair<double, CameraPair>> ranked;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t j = i + 1; j < views.size(); ++j) {
      const CommonViews common = commonViews(views[i], views[j]);
      if (common.first.size() < options.minimum_common_points)
        continue;
      const double points = std::min(static_cast<double>(common.first.size()), kEnough);
      ranked.push_back({-points * distanceFromPlane(common, options.maximum_error), {i, j}});
    }
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<CameraPair> pairs;
  for (const auto& [rank, pair] : ranked)
    pairs.push_back(pair);
  return pairs;
}

bool placePair(const Options& options, const CameraPair& pair, Reconstruction* reconstruction) {
  const NormalizedViews views = normalize(*reconstruction);
  geometry::Camera& first_camera = reconstruction->cameras[pair.first];
  geometry::Camera& second_camera = reconstruction->cameras[pair.second];
  const auto [first, second] = commonViews(views[pair.first], views[pair.second]);
  if (first.size() < options.minimum_common_points || !adjust::fillAnArea(first) ||
      !adjust::fillAnArea(second))
    return false;
  const double focal_length = 0.5 * (focalLength(first_camera) + focalLength(second_camera));
  cv::Mat mask;
  const cv::Mat essential =
      cv::findEssentialMat(first, second, 1.0, cv::Point2d(0.0, 0.0), cv::RANSAC, 0.999,
                           kStartTolerance * options.maximum_error / focal_length, mask);
  if (essential.rows != 3 || essential.cols != 3)
    return false;
  cv::Mat rotation;
  cv::Mat translation;
  const int in_front =
      cv::recoverPose(essential, first, second, rotation, translation, 1.0, {0.0, 0.0}, mask);
  if (in_front < static_cast<int>(options.minimum_common_points))
    return false;
  Eigen::Matrix3d second_from_first;
  cv::cv2eigen(rotation, second_from_first);
  const Eigen::Isometry3d pose = Eigen::Translation3d(adjust::vectorFromCv(translation)) *
                                 Eigen::Isometry3d(second_from_first);
  first_camera.world_from_camera = Eigen::Isometry3d::Identity();
  second_camera.world_from_camera = pose.inverse();
  reconstruction->placed[pair.first] = true;
  reconstruction->placed[pair.second] = true;
  return true;
}

namespace {

/// The known points that a camera saw, and where on its normalised image plane.
struct KnownViews {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> views;
};

KnownViews knownViews(const Reconstruction& reconstruction, std::size_t camera) {
  KnownViews known;
  for (const Observation& observation : reconstruction.observations) {
    const auto& point = reconstruction.points[observation.point];
    if (observation.camera != camera || !point)
      continue;
    const auto view =
        reconstruction.cameras[camera].intrinsics.normalizedFromPixel(observation.pixel);
    if (!view)
      continue;
    known.points.emplace_back(point->x(), point->y(), point->z());
    known.views.emplace_back(view->x(), view->y());
  }
  return known;
}

std::string adviceFor(const std::string& name) {
  return "move the light where " + name + " and two of the others see it, or leave this camera out";
}

}  // namespace

std::size_t nextToResect(const Options& options, const Reconstruction& reconstruction) {
  std::size_t next = 0;
  std::size_t most = 0;
  bool any = false;
  for (std::size_t camera = 0; camera < reconstruction.placed.size(); ++camera) {
    if (reconstruction.placed[camera])
      continue;
    const std::size_t count = knownViews(reconstruction, camera).points.size();
    if (!any || count > most) {
      any = true;
      next = camera;
      most = count;
    }
  }
  const std::string& name = reconstruction.cameras[next].name;
  if (most < options.minimum_common_points)
    throw BundleError(name + " shares " + std::to_string(most) +
                      " points with the cameras placed before it, but needs " +
                      std::to_string(options.minimum_common_points) + ": " + adviceFor(name));
  return next;
}

std::size_t resect(const Options& options, std::size_t index, Reconstruction* reconstruction) {
  geometry::Camera& camera = reconstruction->cameras[index];
  const KnownViews known = knownViews(*reconstruction, index);
  if (!adjust::fillAnArea(known.views))
    throw BundleError(camera.name +
                      " shares only points on one line with the cameras placed before it: " +
                      adviceFor(camera.name));
  cv::Mat rotation_vector;
  cv::Mat translation;
  std::vector<int> inliers;
  const double tolerance = kStartTolerance * options.maximum_error / focalLength(camera);
  const int iterations = options.rough ? 150 : 1000;  // 150 suffice with 50 % outliers
  bool found = false;
  try {
    found = cv::solvePnPRansac(known.points, known.views, cv::Mat::eye(3, 3, CV_64F), cv::noArray(),
                               rotation_vector, translation, false, iterations, tolerance, 0.9999,
                               inliers, cv::SOLVEPNP_EPNP);
  } catch (const cv::Exception&) {
    found = false;  // degenerate points
  }
  if (found)
    camera.world_from_camera = adjust::poseFromCv(rotation_vector, translation).inverse();
  if (!found || inliers.size() < options.minimum_common_points ||
      !camera.world_from_camera.matrix().allFinite())
    throw BundleError("no pose of " + camera.name + " explains what it saw of " +
                      std::to_string(known.points.size()) +
                      " points: check its intrinsics and its frame numbers; or " +
                      adviceFor(camera.name));
  reconstruction->placed[index] = true;
  return inliers.size();
}

}  // namespace wiimote_tracker::bundle
