#include "marker_builder.h"

#include "marker_parts.h"
#include "wiimote_tracker_triangulation/geometry/sight.h"

#include <wiimote_tracker_msgs/doubtful_label.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace wiimote_tracker {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using markers::color;
using markers::kLine;
using markers::kLineWidth;
using visualization_msgs::Marker;
using wiimote_tracker_msgs::TrackedPoint;

constexpr double kPointDiameter = 0.1;     // [m]
constexpr double kBlobDiameter = 0.03;     // [m]
constexpr double kRayLength = 10.0;        // of rays without a point [m]
constexpr double kOldView = 0.2;           // older views are not drawn [s]
constexpr double kNoImages = 0.7;          // without a newer view, a camera counts as silent [s]
constexpr double kLedLifetime = 0.5;       // when the tracker stops [s]
constexpr double kTrailFades = 0.4;        // of an LED that is lost [s]
constexpr double kCameraLifetime = 1.0;    // when the tracker stops [s]
constexpr double kAdviceLifetime = 2.0;    // the same [s]
constexpr std::size_t kMostLabels = 1000;  // whose colours are kept
// Width, height and length of a Wii Remote, twice as large to be seen in a room [m].
const Vector3d kHousing(0.07, 0.06, 0.3);
// Square root of the 95 % quantile of the chi-squared distribution with three degrees of freedom.
constexpr double kSigmas95 = 2.7955;

std_msgs::ColorRGBA colorOf(tracking::SpotUse use) {
  switch (use) {
    case tracking::SpotUse::kAssigned:
      return color(0.1f, 0.8f, 0.2f, 0.5f);
    case tracking::SpotUse::kMasked:
      return color(0.5f, 0.5f, 0.5f, 0.4f);
    case tracking::SpotUse::kUnassigned:
    case tracking::SpotUse::kStart:
      break;
  }
  return color(1.0f, 0.5f, 0.0f, 0.4f);
}

/// Where a pixel lies on the camera's image plane at a distance, in the world [m].
Vector3d onImagePlane(const geometry::Camera& camera, const Vector2d& pixel, double distance) {
  const geometry::Intrinsics& i = camera.intrinsics;
  // A strong lens model may not be invertible at the corners: draw them without distortion.
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

visualization_msgs::MarkerArray MarkerBuilder::buildWithoutRig(double time) const {
  visualization_msgs::MarkerArray array;
  array.markers = {markers::textAbove({rig_.world_frame, time, kAdviceLifetime}, "advice", 0,
                                      Vector3d::Zero(), "Not calibrated: open Calibrate",
                                      color(1.0f, 1.0f, 1.0f, 1.0f))};
  return array;
}

void MarkerBuilder::setRig(const geometry::Rig& rig) {
  const bool is_same = rig.frames() == rig_.frames();
  const bool has_same_places =
      std::equal(rig.cameras.begin(), rig.cameras.end(), rig_.cameras.begin(), rig_.cameras.end(),
                 [](const auto& a, const auto& b) { return haveSamePose(a.camera, b.camera); });
  rig_ = rig;
  if (!has_same_places)
    trails_.clear();  // they may be of another world
  if (is_same)
    return;
  drawn_.clear();
  trails_.clear();
  time_ = -std::numeric_limits<double>::infinity();
}

bool MarkerBuilder::isDue(double time) const {
  return time >= time_ + 1.0 / options_.rate || time < time_;
}

visualization_msgs::MarkerArray MarkerBuilder::build(
    const wiimote_tracker_msgs::TrackedPointArray& points,
    const std::vector<tracking::CameraView>& views) {
  const double time = points.header.stamp.toSec();
  if (time < time_)
    trails_.clear();
  time_ = time;
  array_.markers.clear();
  if (drawn_.empty()) {  // the first array of this rig, since each array shows the cameras
    Marker clear;
    clear.action = Marker::DELETEALL;
    array_.markers.push_back(clear);
  }
  of_cameras_ = {rig_.world_frame, time, std::max(kCameraLifetime, 3.0 / options_.rate)};
  of_leds_ = {rig_.world_frame, time, std::max(kLedLifetime, 3.0 / options_.rate)};
  for (std::size_t i = 0; i < rig_.cameras.size(); ++i) {
    const tracking::CameraView view = i < views.size() ? views[i] : tracking::CameraView();
    addCamera(i, view.time && time - *view.time < kNoImages);
    addMasks(i);
    addView(i, view, points);
  }
  for (const TrackedPoint& point : points.points) {
    if (point.state != TrackedPoint::LOST)
      addLed(point);
  }
  addTrails();
  deleteOld();
  return array_;
}

void MarkerBuilder::addCamera(std::size_t index, bool has_images) {
  const geometry::Camera& camera = rig_.cameras[index].camera;
  const std::array<Vector3d, 4> corners = imageCorners(camera, options_.image_plane_distance);
  const auto shown = has_images ? color(1.0f, 1.0f, 1.0f, 1.0f) : color(0.55f, 0.55f, 0.55f, 1.0f);
  array_.markers.push_back(markers::textAbove(of_cameras_, "camera", index, camera.center(),
                                              camera.name + (has_images ? "" : ": no images"),
                                              shown));

  Marker housing = markers::marker(of_cameras_, "housing", index, Marker::CUBE, kHousing, shown);
  housing.pose.position =
      pointOf(camera.world_from_camera * Vector3d(0.0, 0.0, -0.5 * kHousing.z()));
  setRotation(Eigen::Quaterniond(camera.world_from_camera.rotation()), &housing.pose.orientation);
  array_.markers.push_back(housing);

  Marker frustum =
      markers::marker(of_cameras_, "frustum", index, Marker::LINE_LIST, kLine,
                      has_images ? color(0.35f, 0.6f, 1.0f, 1.0f) : color(0.4f, 0.4f, 0.4f, 1.0f));
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const geometry_msgs::Point corner = pointOf(corners[i]);
    frustum.points.insert(frustum.points.end(), {pointOf(camera.center()), corner, corner,
                                                 pointOf(corners[(i + 1) % corners.size()])});
  }
  array_.markers.push_back(frustum);

  Marker plane =
      markers::marker(of_cameras_, "image_plane", index, Marker::TRIANGLE_LIST, Vector3d::Ones(),
                      has_images ? color(0.4f, 0.6f, 1.0f, 0.3f) : color(0.4f, 0.4f, 0.4f, 0.5f));
  for (const std::size_t i : {0, 1, 2, 0, 2, 3})
    plane.points.push_back(pointOf(corners[i]));
  array_.markers.push_back(plane);
}

/// Discs on the image plane.
void MarkerBuilder::addMasks(std::size_t index) {
  constexpr int kSides = 24;
  const geometry::RigCamera& camera = rig_.cameras[index];
  Marker discs = markers::marker(of_cameras_, "mask", index, Marker::TRIANGLE_LIST,
                                 Vector3d::Ones(), color(0.2f, 0.2f, 0.2f, 0.8f));
  for (const geometry::ImageMask& mask : camera.masks) {
    const auto border = [&](int i) {
      const double angle = 2.0 * M_PI * i / kSides;
      return pointOf(onImagePlane(
          camera.camera, mask.center + mask.radius * Vector2d(std::cos(angle), std::sin(angle)),
          options_.image_plane_distance));
    };
    const geometry_msgs::Point center =
        pointOf(onImagePlane(camera.camera, mask.center, options_.image_plane_distance));
    for (int i = 0; i < kSides; ++i)
      discs.points.insert(discs.points.end(), {center, border(i), border(i + 1)});
  }
  markers::add(discs, &array_);
}

/// Spots and rays of one camera. A ray to an LED is wider and clearer the better the LED's position
/// is known.
void MarkerBuilder::addView(std::size_t index,
                            const tracking::CameraView& view,
                            const wiimote_tracker_msgs::TrackedPointArray& points) {
  const geometry::Camera camera = rig_.rayCamera(rig_.cameras[index]);
  Marker blobs = markers::marker(of_leds_, "blob", index, Marker::SPHERE_LIST,
                                 Vector3d::Constant(kBlobDiameter), color(1.0f, 1.0f, 1.0f, 1.0f));
  std::size_t rays = 0;
  const bool is_new = view.time && std::abs(time_ - *view.time) < kOldView;
  for (const tracking::SeenSpot& spot : is_new ? view.spots : std::vector<tracking::SeenSpot>()) {
    const auto sight = geometry::sightFromPixel(camera, spot.pixel);
    if (!sight)
      continue;
    blobs.points.push_back(
        pointOf(onImagePlane(camera, spot.pixel, options_.image_plane_distance)));
    blobs.colors.push_back(colorOf(spot.use));
    if (spot.use == tracking::SpotUse::kMasked)
      continue;
    const auto led =
        std::find_if(points.points.begin(), points.points.end(), [&](const TrackedPoint& point) {
          return spot.use == tracking::SpotUse::kAssigned && point.id == spot.led;
        });
    double length = kRayLength;
    Marker ray = markers::marker(of_leds_, "ray", index + rig_.cameras.size() * rays++,
                                 Marker::LINE_LIST, kLine, colorOf(spot.use));
    if (led != points.points.end()) {
      length = (vectorOf(led->position) - camera.center()).norm();
      const auto& c = led->position_covariance;
      const double quality = markers::qualityOf(std::sqrt(c[0] + c[4] + c[8]));
      ray.scale.x *= 0.5 + 1.5 * quality;
      ray.color.a = static_cast<float>(0.15 + 0.45 * quality);
    }
    ray.points.push_back(pointOf(camera.center()));
    ray.points.push_back(pointOf(camera.center() + length * sight->direction));
    array_.markers.push_back(ray);
  }
  markers::add(blobs, &array_);
}

void MarkerBuilder::addLed(const TrackedPoint& led) {
  // Tentative and predicted LEDs are pale. The former are grey: most of them never get a label.
  const float alpha = led.state == TrackedPoint::TRACKED ? 1.0f : 0.4f;
  const auto own_color = [&](float share) {
    return led.state == TrackedPoint::TENTATIVE ? color(0.7f, 0.7f, 0.7f, share)
                                                : colorOfLed(led.label, share);
  };
  Marker point = markers::marker(of_leds_, "point", led.id, Marker::SPHERE,
                                 Vector3d::Constant(kPointDiameter), own_color(alpha));
  point.pose.position = led.position;
  array_.markers.push_back(point);

  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(matrixOf<3>(led.position_covariance));
  Eigen::Matrix3d rotation = axes.eigenvectors();
  if (rotation.determinant() < 0.0)
    rotation.col(0) = -rotation.col(0);
  // rviz warns about a scale of 0.
  Marker ellipsoid =
      markers::marker(of_leds_, "covariance", led.id, Marker::SPHERE,
                      2.0 * kSigmas95 * axes.eigenvalues().cwiseMax(1e-12).cwiseSqrt(),
                      color(1.0f, 0.2f, 1.0f, 0.4f * alpha));
  ellipsoid.pose.position = led.position;
  setRotation(Eigen::Quaterniond(rotation), &ellipsoid.pose.orientation);
  array_.markers.push_back(ellipsoid);

  array_.markers.push_back(markers::textAbove(of_leds_, "label", led.id, vectorOf(led.position),
                                              shownLabel(led.label, led.label_confidence),
                                              own_color(alpha)));

  Marker height = markers::marker(of_leds_, "height", led.id, Marker::LINE_LIST, kLine,
                                  own_color(0.3f * alpha));
  Marker shadow =
      markers::marker(of_leds_, "shadow", led.id, Marker::SPHERE_LIST,
                      {kPointDiameter, kPointDiameter, kLineWidth}, own_color(0.3f * alpha));
  if (rig_.square_sides.size() == 2) {  // z = 0 is the plane of a calibration square
    height.points.resize(2, led.position);
    height.points[1].z = 0.0;
    shadow.points = {height.points[1]};
  }
  markers::add(height, &array_);
  markers::add(shadow, &array_);

  if (led.state != TrackedPoint::TENTATIVE) {
    Trail& trail = trails_[led.id];
    trail.color = own_color(0.8f);
    trail.places.push_back({time_, led.position});
  }
}

/// Labels that come after each other have different colours.
std_msgs::ColorRGBA MarkerBuilder::colorOfLed(const std::string& label, float alpha) {
  static const std::array<std_msgs::ColorRGBA, 6> colors = {
      color(1.0f, 0.35f, 0.3f, 1.0f), color(0.3f, 0.65f, 1.0f, 1.0f),
      color(1.0f, 0.9f, 0.2f, 1.0f),  color(0.9f, 0.45f, 1.0f, 1.0f),
      color(0.2f, 0.9f, 0.8f, 1.0f),  color(1.0f, 0.65f, 0.5f, 1.0f)};
  if (labels_.size() > kMostLabels)
    labels_.clear();
  std_msgs::ColorRGBA result =
      colors[labels_.emplace(label, labels_.size()).first->second % colors.size()];
  result.a = alpha;
  return result;
}

void MarkerBuilder::addTrails() {
  for (auto trail = trails_.begin(); trail != trails_.end();) {
    std::deque<Place>& places = trail->second.places;
    const double left = 1.0 - (time_ - places.back().time) / kTrailFades;
    while (!places.empty() && places.front().time < time_ - options_.trail_duration)
      places.pop_front();
    if (places.empty() || left <= 0.0) {
      trail = trails_.erase(trail);
      continue;
    }
    Marker line = markers::marker(of_leds_, "trail", trail->first, Marker::LINE_STRIP, kLine,
                                  trail->second.color);
    line.color.a *= static_cast<float>(left);
    for (const Place& place : places)
      line.points.push_back(place.position);
    if (places.size() > 1)
      array_.markers.push_back(line);
    ++trail;
  }
}

/// Deletes what was in the last array and is not in this one.
void MarkerBuilder::deleteOld() {
  std::set<std::pair<std::string, int>> drawn;
  for (const Marker& marker : array_.markers) {
    if (marker.action != Marker::DELETEALL)
      drawn.emplace(marker.ns, marker.id);
  }
  for (const auto& [ns, id] : drawn_) {
    if (drawn.count({ns, id}) > 0)
      continue;
    Marker old = markers::marker(of_leds_, ns, id, Marker::POINTS, Vector3d::Ones(), {});
    old.action = Marker::DELETE;
    array_.markers.push_back(old);
  }
  drawn_ = std::move(drawn);
}

}  // namespace wiimote_tracker
