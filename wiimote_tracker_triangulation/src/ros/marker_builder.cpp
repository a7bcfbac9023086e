#include "marker_builder.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace wiimote_tracker {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using visualization_msgs::Marker;

constexpr double kPointDiameter = 0.03;  // [m]
constexpr double kBlobDiameter = 0.02;   // [m]
constexpr double kLineWidth = 0.005;     // [m]
constexpr double kTextHeight = 0.1;      // [m]
constexpr double kRayLength = 10.0;      // where there is no point to end in [m]
// Square root of the 95 % quantile of the chi-squared distribution with three degrees of freedom.
constexpr double kSigmas95 = 2.7955;

geometry_msgs::Point pointOf(const Vector3d& v) {
  geometry_msgs::Point p;
  p.x = v.x();
  p.y = v.y();
  p.z = v.z();
  return p;
}

void setColor(float r, float g, float b, float a, Marker* marker) {
  marker->color.r = r;
  marker->color.g = g;
  marker->color.b = b;
  marker->color.a = a;
}

void setScale(const Vector3d& scale, Marker* marker) {
  marker->scale.x = scale.x();
  marker->scale.y = scale.y();
  marker->scale.z = scale.z();
}

/// Where a pixel lies on the camera's image plane at a distance, in the world [m].
Vector3d onImagePlane(const geometry::Camera& camera, const Vector2d& pixel, double distance) {
  const geometry::Intrinsics& i = camera.intrinsics;
  // Corners may lie beyond the fold of a strong lens: there, draw them without distortion.
  const Vector2d n = i.normalizedFromPixel(pixel).value_or(
      Vector2d((pixel.x() - i.cx) / i.fx, (pixel.y() - i.cy) / i.fy));
  return camera.world_from_camera * Vector3d(distance * n.x(), distance * n.y(), distance);
}

std::array<Vector3d, 4> imageCorners(const geometry::Camera& camera, double distance) {
  const double right = camera.intrinsics.width - 0.5;
  const double bottom = camera.intrinsics.height - 0.5;
  return {onImagePlane(camera, {-0.5, -0.5}, distance),
          onImagePlane(camera, {right, -0.5}, distance),
          onImagePlane(camera, {right, bottom}, distance),
          onImagePlane(camera, {-0.5, bottom}, distance)};
}

}  // namespace

void MarkerBuilder::setRig(const geometry::Rig& rig) {
  rig_ = rig;
  must_clear_ = true;
  trail_.clear();
  time_ = -std::numeric_limits<double>::infinity();
}

bool MarkerBuilder::isDue(double time) const {
  return time >= time_ + 1.0 / options_.rate || time < time_;
}

visualization_msgs::MarkerArray MarkerBuilder::build(const fusion::Instant& instant) {
  if (instant.time < time_)
    trail_.clear();
  time_ = instant.time;
  array_.markers.clear();
  if (must_clear_) {
    Marker clear;
    clear.action = Marker::DELETEALL;
    array_.markers.push_back(clear);
    must_clear_ = false;
  }
  for (std::size_t i = 0; i < rig_.cameras.size(); ++i)
    addCamera(i, instant);
  addPoint(instant);
  addTrail(instant);
  return array_;
}

Marker MarkerBuilder::marker(const std::string& ns, std::size_t id, int type) const {
  Marker marker;
  marker.header.frame_id = rig_.world_frame;
  marker.header.stamp = ros::Time(std::max(0.0, time_));
  marker.ns = ns;
  marker.id = static_cast<int>(id);
  marker.type = type;
  marker.pose.orientation.w = 1.0;
  // So that a point does not stay in the picture when the tracker falls silent.
  marker.lifetime = ros::Duration(std::max(1.0, 3.0 / options_.rate));
  return marker;
}

void MarkerBuilder::addCamera(std::size_t index, const fusion::Instant& instant) {
  const geometry::Camera& camera = rig_.cameras[index].camera;
  const geometry::Camera ray_camera = rig_.rayCamera(rig_.cameras[index]);
  const double distance = options_.image_plane_distance;
  const std::array<Vector3d, 4> corners = imageCorners(camera, distance);

  Marker name = marker("camera", index, Marker::TEXT_VIEW_FACING);
  name.pose.position = pointOf(camera.center() + kTextHeight * Vector3d::UnitZ());
  name.text = camera.name;
  name.scale.z = kTextHeight;
  setColor(1.0f, 1.0f, 1.0f, 1.0f, &name);
  array_.markers.push_back(name);

  Marker frustum = marker("frustum", index, Marker::LINE_LIST);
  frustum.scale.x = kLineWidth;
  setColor(0.6f, 0.6f, 0.6f, 1.0f, &frustum);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    frustum.points.push_back(pointOf(camera.center()));
    frustum.points.push_back(pointOf(corners[i]));
    frustum.points.push_back(pointOf(corners[i]));
    frustum.points.push_back(pointOf(corners[(i + 1) % corners.size()]));
  }
  array_.markers.push_back(frustum);

  Marker plane = marker("image_plane", index, Marker::TRIANGLE_LIST);
  setScale(Vector3d::Ones(), &plane);
  setColor(0.4f, 0.6f, 1.0f, 0.3f, &plane);
  for (const std::size_t i : {0, 1, 2, 0, 2, 3})
    plane.points.push_back(pointOf(corners[i]));
  array_.markers.push_back(plane);

  const fusion::Sighting& sighting = instant.sightings[index];
  Marker blob = marker("blob", index, Marker::SPHERE);
  Marker ray = marker("ray", index, Marker::LINE_LIST);
  const auto direction =
      sighting.pixel ? geometry::rayFromPixel(ray_camera, *sighting.pixel) : std::nullopt;
  if (direction) {
    blob.pose.position = pointOf(onImagePlane(ray_camera, *sighting.pixel, distance));
    setScale(Vector3d::Constant(kBlobDiameter), &blob);
    setColor(1.0f, 1.0f, 0.2f, 1.0f, &blob);
    const double length = instant.point && sighting.used
                              ? (instant.point->position - camera.center()).norm()
                              : kRayLength;
    ray.scale.x = kLineWidth;
    ray.points = {pointOf(camera.center()),
                  pointOf(camera.center() + length * direction->direction)};
    if (sighting.used)
      setColor(0.2f, 1.0f, 0.2f, 0.6f, &ray);
    else
      setColor(1.0f, 0.5f, 0.0f, 0.6f, &ray);
  } else {
    blob.action = Marker::DELETE;
    ray.action = Marker::DELETE;
  }
  array_.markers.push_back(blob);
  array_.markers.push_back(ray);
}

void MarkerBuilder::addPoint(const fusion::Instant& instant) {
  Marker point = marker("point", 0, Marker::SPHERE);
  Marker ellipsoid = marker("covariance", 0, Marker::SPHERE);
  if (instant.point) {
    point.pose.position = pointOf(instant.point->position);
    setScale(Vector3d::Constant(kPointDiameter), &point);
    setColor(1.0f, 0.2f, 0.2f, 1.0f, &point);

    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(instant.point->covariance);
    Eigen::Matrix3d rotation = axes.eigenvectors();
    if (rotation.determinant() < 0.0)
      rotation.col(0) = -rotation.col(0);
    const Eigen::Quaterniond q(rotation);
    ellipsoid.pose.position = point.pose.position;
    ellipsoid.pose.orientation.w = q.w();
    ellipsoid.pose.orientation.x = q.x();
    ellipsoid.pose.orientation.y = q.y();
    ellipsoid.pose.orientation.z = q.z();
    // rviz warns about a scale of 0.
    setScale(2.0 * kSigmas95 * axes.eigenvalues().cwiseMax(1e-12).cwiseSqrt(), &ellipsoid);
    setColor(1.0f, 0.2f, 1.0f, 0.4f, &ellipsoid);
  } else {
    point.action = Marker::DELETE;
    ellipsoid.action = Marker::DELETE;
  }
  array_.markers.push_back(point);
  array_.markers.push_back(ellipsoid);
}

void MarkerBuilder::addTrail(const fusion::Instant& instant) {
  while (!trail_.empty() && trail_.front().first < instant.time - options_.trail_duration)
    trail_.pop_front();
  if (instant.point)
    trail_.emplace_back(instant.time, instant.point->position);
  Marker trail = marker("trail", 0, Marker::LINE_STRIP);
  trail.scale.x = kLineWidth;
  setColor(1.0f, 0.6f, 0.6f, 0.8f, &trail);
  for (const auto& entry : trail_)
    trail.points.push_back(pointOf(entry.second));
  if (trail_.size() < 2)
    trail.action = Marker::DELETE;
  array_.markers.push_back(trail);
}

}  // namespace wiimote_tracker
