// Markers and point messages of a snapshot.
#include "geometry/random_rigs.h"
#include "ros/marker_builder.h"
#include "ros/point_message.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <gtest/gtest.h>

#include <set>

namespace wiimote_tracker {
namespace {

using Eigen::Vector3d;
using geometry::Rig;
using tracking::TrackedLed;
using tracking::TrackState;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;
using wiimote_tracker_msgs::TrackedPoint;
using wiimote_tracker_msgs::TrackedPointArray;

const Vector3d kLed(0.1, 0.2, 0.3);

Rig threeCameras() {
  geometry::test::Random random(71);
  return geometry::test::randomRig(random, 3);
}

TrackedLed someLed(std::uint32_t id, double time, const Vector3d& position) {
  TrackedLed led;
  led.id = id;
  led.state = TrackState::kTracked;
  led.position = position;
  led.position_covariance << 4e-6, 1e-6, 0.0, 1e-6, 9e-6, 0.0, 0.0, 0.0, 1e-6;
  led.cameras = {0, 1};
  led.rays_possible = 3;
  led.residual = 0.25;
  led.first_seen = 98.0;
  led.last_observed = time - 0.001;
  return led;
}

/// Cameras 0 and 1 see the LED, camera 2 does not.
CorrectedSnapshot someSnapshot(const Rig& rig, double time = 100.0) {
  CorrectedSnapshot corrected;
  tracking::Snapshot& snapshot = corrected.snapshot;
  snapshot.time = time;
  snapshot.latest_arrival = time + 0.03;
  snapshot.skew = 0.004;
  snapshot.leds = {someLed(0, time, kLed)};
  corrected.remapped = {false};
  snapshot.views.resize(3);
  for (std::size_t i = 0; i < 3; ++i)
    snapshot.views[i].time = time - 0.001 * i;
  for (std::size_t i = 0; i < 2; ++i)
    snapshot.views[i].spots = {
        {*rig.cameras[i].camera.project(kLed), tracking::SpotUse::kAssigned, 0}};
  return corrected;
}

TrackedPointArray messageOf(const CorrectedSnapshot& corrected, const Rig& rig) {
  LedLabels labels({"led"});
  labels.update(corrected.snapshot.time, corrected.snapshot.leds);
  PointContext context;
  context.method = "track";
  context.rig_id = "0123";
  context.late_frames = 7;
  return pointMessage(corrected, rig, labels, context);
}

MarkerArray draw(MarkerBuilder* builder, const CorrectedSnapshot& corrected, const Rig& rig) {
  return builder->build(messageOf(corrected, rig), corrected.snapshot.views);
}

const Marker& find(const MarkerArray& array, const std::string& ns, int id) {
  for (const Marker& marker : array.markers) {
    if (marker.ns == ns && marker.id == id && marker.action != Marker::DELETEALL)
      return marker;
  }
  throw std::logic_error("no marker " + ns + " " + std::to_string(id));
}

TEST(PointMessage, HoldsOnlyKnownValues) {
  const Rig rig = threeCameras();
  const auto message = messageOf(someSnapshot(rig), rig);
  EXPECT_EQ(ros::Time(100.0), message.header.stamp);
  EXPECT_EQ("world", message.header.frame_id);
  EXPECT_EQ("0123", message.rig_id);
  EXPECT_EQ("track", message.method);
  EXPECT_EQ(ros::Time(100.03), message.latest_arrival);
  EXPECT_EQ(0.004, message.skew);
  EXPECT_EQ(7u, message.late_frames);
  ASSERT_EQ(1u, message.points.size());
  const TrackedPoint& point = message.points[0];
  EXPECT_EQ("led", point.label);
  EXPECT_EQ(TrackedPoint::TRACKED, point.state);
  EXPECT_EQ(kLed, vectorOf(point.position));
  EXPECT_EQ(9e-6, point.position_covariance[4]);
  EXPECT_EQ(1e-6, point.position_covariance[1]);
  EXPECT_TRUE(std::isnan(point.velocity.x));
  EXPECT_TRUE(std::isnan(point.velocity_covariance[8]));
  EXPECT_TRUE(std::isnan(point.label_confidence));
  EXPECT_TRUE(point.label_since.isZero());
  EXPECT_EQ(2u, point.rays_used);
  EXPECT_EQ(3u, point.rays_possible);
  EXPECT_EQ((std::vector<std::string>{"camera_0", "camera_1"}), point.cameras);
  EXPECT_EQ(0.25, point.residual);
  EXPECT_EQ(ros::Time(99.999), point.last_observed);
  EXPECT_NEAR(2.0, point.age, 1e-12);
  EXPECT_FALSE(point.remapped);
}

TEST(PointMessage, SaysVelocityAndStateOfEachLed) {
  const Rig rig = threeCameras();
  CorrectedSnapshot corrected = someSnapshot(rig);
  corrected.snapshot.leds.push_back(someLed(4, 100.0, {1.0, 0.0, 0.0}));
  corrected.remapped.push_back(true);
  TrackedLed& second = corrected.snapshot.leds[1];
  second.state = TrackState::kPredicted;
  second.velocity = Vector3d(1.0, 2.0, 3.0);
  second.velocity_covariance = Vector3d(4.0, 5.0, 6.0).asDiagonal();
  const auto message = messageOf(corrected, rig);
  ASSERT_EQ(2u, message.points.size());
  const TrackedPoint& point = message.points[1];
  EXPECT_EQ(4u, point.id);
  EXPECT_EQ("led_4", point.label);
  EXPECT_EQ(TrackedPoint::PREDICTED, point.state);
  EXPECT_EQ(2.0, point.velocity.y);
  EXPECT_EQ(6.0, point.velocity_covariance[8]);
  EXPECT_TRUE(point.remapped);
}

TEST(PointMessage, IsEmptyWithoutALed) {
  const Rig rig = threeCameras();
  CorrectedSnapshot corrected = someSnapshot(rig);
  corrected.snapshot.leds.clear();
  const auto message = messageOf(corrected, rig);
  EXPECT_TRUE(message.points.empty());
  EXPECT_EQ(ros::Time(100.0), message.header.stamp);
}

TEST(PointMessage, OnlyObservedLedsHaveAPosition) {
  TrackedPoint point;
  for (const bool publish_predicted : {false, true}) {
    point.state = TrackedPoint::TENTATIVE;
    EXPECT_FALSE(isPosition(point, publish_predicted));
    point.state = TrackedPoint::TRACKED;
    EXPECT_TRUE(isPosition(point, publish_predicted));
    point.state = TrackedPoint::PREDICTED;
    EXPECT_EQ(publish_predicted, isPosition(point, publish_predicted));
    point.state = TrackedPoint::LOST;
    EXPECT_FALSE(isPosition(point, publish_predicted));
  }
}

TEST(VolumeCorrection, MovesPositionsAndVelocities) {
  Rig rig = threeCameras();
  rig.remap = remap::Remap{rig.id(), remap::Model::kAffine, std::vector<double>(12, 0.0), {}};
  rig.remap->parameters[2] = 0.1;  // upwards
  rig.remap->parameters[3] = 0.5;  // along x, the more the further
  for (int corner = 0; corner < 8; ++corner)
    rig.remap->support.emplace_back(corner % 2 ? 1.0 : -1.0, corner / 2 % 2 ? 1.0 : -1.0,
                                    corner / 4 ? 1.0 : -1.0);
  VolumeCorrection correction;
  EXPECT_TRUE(correction.take(rig));
  CorrectedSnapshot raw = someSnapshot(rig);
  raw.snapshot.leds.push_back(someLed(1, 100.0, {0.0, 0.0, 5.0}));
  raw.snapshot.leds[0].velocity = Vector3d(1.0, 2.0, 3.0);
  raw.snapshot.leds[0].velocity_covariance.setIdentity();
  CorrectedSnapshot corrected;
  correction.apply(raw.snapshot, &corrected);
  ASSERT_EQ(2u, corrected.snapshot.leds.size());
  EXPECT_EQ((std::vector<bool>{true, false}), corrected.remapped);
  // The velocity matches differences of corrected positions.
  constexpr double kStep = 1e-6;
  CorrectedSnapshot later = raw;
  later.snapshot.leds[0].position += kStep * *raw.snapshot.leds[0].velocity;
  CorrectedSnapshot later_corrected;
  correction.apply(later.snapshot, &later_corrected);
  const Vector3d expected =
      (later_corrected.snapshot.leds[0].position - corrected.snapshot.leds[0].position) / kStep;
  EXPECT_LT((*corrected.snapshot.leds[0].velocity - expected).norm(), 1e-6);
  EXPECT_GT((expected - *raw.snapshot.leds[0].velocity).norm(), 0.1);
  EXPECT_NEAR(kLed.z() + 0.1, corrected.snapshot.leds[0].position.z(), 1e-9);
}

TEST(Markers, HaveUniqueNamesAndTheWorldFrame) {
  const Rig rig = threeCameras();
  MarkerBuilder builder({});
  builder.setRig(rig);
  const MarkerArray array = draw(&builder, someSnapshot(rig), rig);
  ASSERT_FALSE(array.markers.empty());
  EXPECT_EQ(Marker::DELETEALL, array.markers[0].action) << "a new rig clears the old one";
  std::set<std::pair<std::string, int>> names;
  for (std::size_t i = 1; i < array.markers.size(); ++i) {
    const Marker& marker = array.markers[i];
    EXPECT_TRUE(names.insert({marker.ns, marker.id}).second) << marker.ns << " " << marker.id;
    EXPECT_EQ("world", marker.header.frame_id);
    EXPECT_EQ(ros::Time(100.0), marker.header.stamp);
    EXPECT_GT(marker.lifetime.toSec(), 0.0);
    if (marker.action == Marker::ADD &&
        (marker.type == Marker::SPHERE || marker.type == Marker::SPHERE_LIST)) {
      EXPECT_GT(std::min({marker.scale.x, marker.scale.y, marker.scale.z}), 0.0);
    }
  }
  const MarkerArray next = draw(&builder, someSnapshot(rig, 100.1), rig);
  EXPECT_NE(Marker::DELETEALL, next.markers[0].action);
}

TEST(Markers, ShowWhereTheCamerasLook) {
  const Rig rig = threeCameras();
  MarkerOptions options;
  options.image_plane_distance = 0.7;
  MarkerBuilder builder(options);
  builder.setRig(rig);
  const MarkerArray array = draw(&builder, someSnapshot(rig), rig);
  for (int i = 0; i < 3; ++i) {
    const geometry::Camera& camera = rig.cameras[i].camera;
    const Marker plane = find(array, "image_plane", i);
    EXPECT_EQ(6u, plane.points.size());
    for (const auto& p : plane.points) {
      // On the plane, and at the image's edge.
      const Vector3d in_camera = camera.world_from_camera.inverse() * vectorOf(p);
      EXPECT_NEAR(0.7, in_camera.z(), 1e-12);
      const auto pixel = camera.project(vectorOf(p));
      ASSERT_TRUE(pixel);
      EXPECT_NEAR(0.5 * camera.intrinsics.width,
                  std::abs(pixel->x() - 0.5 * (camera.intrinsics.width - 1)), 1e-6);
    }
    EXPECT_EQ(16u, find(array, "frustum", i).points.size());
    EXPECT_EQ(camera.name, find(array, "camera", i).text);
    // The housing lies behind the lens, along the optical axis.
    const Marker housing = find(array, "housing", i);
    const Vector3d in_camera = camera.world_from_camera.inverse() * vectorOf(housing.pose.position);
    EXPECT_LT((in_camera - Vector3d(0.0, 0.0, -0.5 * housing.scale.z)).norm(), 1e-12);
    const auto& q = housing.pose.orientation;
    EXPECT_TRUE((Eigen::Quaterniond(q.w, q.x, q.y, q.z) * Vector3d::UnitZ())
                    .isApprox(camera.world_from_camera.linear().col(2), 1e-12));
  }
}

TEST(Markers, RaysGoFromTheCameraThroughItsBlobToThePoint) {
  const Rig rig = threeCameras();
  MarkerBuilder builder({});
  builder.setRig(rig);
  const MarkerArray array = draw(&builder, someSnapshot(rig), rig);
  for (int i = 0; i < 2; ++i) {
    const Marker ray = find(array, "ray", i);
    ASSERT_EQ(2u, ray.points.size());
    const Vector3d from = vectorOf(ray.points[0]);
    const Vector3d to = vectorOf(ray.points[1]);
    EXPECT_LT((from - rig.cameras[i].camera.center()).norm(), 1e-12);
    EXPECT_LT((to - kLed).norm(), 1e-9);
    const Vector3d blob = vectorOf(find(array, "blob", i).points.at(0));
    EXPECT_LT((blob - from).cross(to - from).norm(), 1e-9);
  }
  EXPECT_EQ(Marker::DELETE, find(array, "ray", 2).action);
  EXPECT_EQ(Marker::DELETE, find(array, "blob", 2).action);
  EXPECT_LT((vectorOf(find(array, "point", 0).pose.position) - kLed).norm(), 1e-12);
}

TEST(Markers, EllipsoidHolds95Percent) {
  const Rig rig = threeCameras();
  MarkerBuilder builder({});
  builder.setRig(rig);
  const CorrectedSnapshot corrected = someSnapshot(rig);
  const Marker ellipsoid = find(draw(&builder, corrected, rig), "covariance", 0);
  const Eigen::Quaterniond q(ellipsoid.pose.orientation.w, ellipsoid.pose.orientation.x,
                             ellipsoid.pose.orientation.y, ellipsoid.pose.orientation.z);
  EXPECT_NEAR(1.0, q.norm(), 1e-12);
  // Draw errors with that covariance; count how many fall into the drawn body.
  geometry::test::Random random(72);
  const Eigen::Matrix3d L = corrected.snapshot.leds[0].position_covariance.llt().matrixL();
  constexpr int kDraws = 100000;
  int inside = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.gaussian();
    const double y = random.gaussian();
    const Vector3d in_body = q.conjugate() * Vector3d(L * Vector3d(x, y, random.gaussian()));
    const Vector3d half(ellipsoid.scale.x, ellipsoid.scale.y, ellipsoid.scale.z);
    inside += (2.0 * in_body).cwiseQuotient(half).norm() < 1.0;
  }
  EXPECT_NEAR(0.95, static_cast<double>(inside) / kDraws, 0.003);
}

TEST(Markers, ALostPointIsRemovedAndTheTrailFades) {
  const Rig rig = threeCameras();
  MarkerOptions options;
  options.trail_duration = 1.0;
  MarkerBuilder builder(options);
  builder.setRig(rig);
  MarkerArray array;
  for (int i = 0; i < 40; ++i)
    array = draw(&builder, someSnapshot(rig, 100.0 + 0.05 * i), rig);
  EXPECT_NEAR(21.0, static_cast<double>(find(array, "trail", 0).points.size()), 1.0);
  CorrectedSnapshot lost = someSnapshot(rig, 102.0);
  lost.snapshot.leds[0].state = TrackState::kLost;
  for (tracking::CameraView& view : lost.snapshot.views)
    view.spots.clear();
  array = draw(&builder, lost, rig);
  for (const std::string ns : {"point", "covariance", "height", "shadow", "label"})
    EXPECT_EQ(Marker::DELETE, find(array, ns, 0).action) << ns;
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(Marker::DELETE, find(array, "ray", i).action);
  EXPECT_EQ(Marker::ADD, find(array, "trail", 0).action);
  lost.snapshot.leds.clear();
  lost.snapshot.time = 105.0;
  array = draw(&builder, lost, rig);
  EXPECT_EQ(Marker::DELETE, find(array, "trail", 0).action);
}

TEST(Markers, EveryLedIsDrawnWithItsName) {
  const Rig rig = threeCameras();
  MarkerBuilder builder({});
  builder.setRig(rig);
  CorrectedSnapshot corrected = someSnapshot(rig);
  corrected.snapshot.leds.push_back(someLed(3, 100.0, {1.0, 0.0, 0.5}));
  corrected.snapshot.leds[1].state = TrackState::kPredicted;
  corrected.remapped.push_back(false);
  MarkerArray array = draw(&builder, corrected, rig);
  EXPECT_EQ("led", find(array, "label", 0).text);
  EXPECT_EQ("led_3", find(array, "label", 3).text);
  EXPECT_EQ(1.0, find(array, "point", 3).pose.position.x);
  EXPECT_LT(find(array, "point", 3).color.a, find(array, "point", 0).color.a)
      << "what is not seen is pale";
  EXPECT_EQ(Marker::ADD, find(array, "covariance", 3).action);
  // A point that vanishes without being reported lost is removed too.
  corrected.snapshot.leds.pop_back();
  corrected.snapshot.time = 100.1;
  array = draw(&builder, corrected, rig);
  EXPECT_EQ(Marker::DELETE, find(array, "point", 3).action);
  EXPECT_EQ(Marker::ADD, find(array, "point", 0).action);
}

TEST(Markers, ShowMaskedAndUnassignedSpots) {
  Rig rig = threeCameras();
  rig.cameras[0].masks = {{{300.0, 200.0}, 25.0}};
  MarkerOptions options;
  MarkerBuilder builder(options);
  builder.setRig(rig);
  CorrectedSnapshot corrected = someSnapshot(rig);
  corrected.snapshot.views[0].spots.push_back({{310.0, 200.0}, tracking::SpotUse::kMasked, 0});
  corrected.snapshot.views[0].spots.push_back({{500.0, 300.0}, tracking::SpotUse::kUnassigned, 0});
  const MarkerArray array = draw(&builder, corrected, rig);
  const Marker mask = find(array, "mask", 0);
  ASSERT_FALSE(mask.points.empty());
  for (const auto& p : mask.points) {
    const auto pixel = rig.cameras[0].camera.project(vectorOf(p));
    ASSERT_TRUE(pixel);
    EXPECT_LT((*pixel - Eigen::Vector2d(300.0, 200.0)).norm(), 25.0 + 1e-6);
  }
  EXPECT_EQ(Marker::DELETE, find(array, "mask", 1).action);
  const Marker blobs = find(array, "blob", 0);
  ASSERT_EQ(3u, blobs.points.size());
  ASSERT_EQ(3u, blobs.colors.size());
  EXPECT_NE(blobs.colors[0], blobs.colors[1]);
  EXPECT_NE(blobs.colors[1], blobs.colors[2]);
  EXPECT_NE(blobs.colors[0], blobs.colors[2]);
  EXPECT_EQ(4u, find(array, "ray", 0).points.size()) << "none of the masked spot";
}

TEST(Markers, OldSpotsAreNotDrawn) {
  const Rig rig = threeCameras();
  MarkerBuilder builder({});
  builder.setRig(rig);
  CorrectedSnapshot corrected = someSnapshot(rig);
  corrected.snapshot.views[1].time = 98.0;
  const MarkerArray array = draw(&builder, corrected, rig);
  EXPECT_EQ(Marker::ADD, find(array, "ray", 0).action);
  EXPECT_EQ(Marker::DELETE, find(array, "ray", 1).action);
}

TEST(Markers, ACameraWithoutImagesIsGreyAndSaysSo) {
  const Rig rig = threeCameras();
  MarkerBuilder builder({});
  builder.setRig(rig);
  CorrectedSnapshot corrected = someSnapshot(rig);
  corrected.snapshot.views[1].time = 99.2;
  corrected.snapshot.views[2].time.reset();
  const MarkerArray array = draw(&builder, corrected, rig);
  EXPECT_EQ("camera_0", find(array, "camera", 0).text);
  for (int i = 1; i < 3; ++i) {
    EXPECT_EQ(rig.cameras[i].camera.name + ": no images", find(array, "camera", i).text);
    const auto& color = find(array, "frustum", i).color;
    EXPECT_EQ(color.r, color.b) << "grey";
  }
}

TEST(Markers, ALabelKeepsItsColourOnAnotherTrack) {
  const Rig rig = threeCameras();
  MarkerBuilder builder({});
  builder.setRig(rig);
  auto points = messageOf(someSnapshot(rig), rig);
  const MarkerArray before = builder.build(points, {});
  points.points[0].id = 7;
  const MarkerArray after = builder.build(points, {});
  EXPECT_EQ(find(before, "point", 0).color, find(after, "point", 7).color);
}

TEST(Markers, TentativeLedsUseUpNoColours) {
  const Rig rig = threeCameras();
  MarkerBuilder fresh({}), builder({});
  fresh.setRig(rig);
  builder.setRig(rig);
  auto points = messageOf(someSnapshot(rig), rig);
  points.points.resize(2, points.points[0]);
  TrackedPoint& other = points.points[1];
  other.id = 3;
  other.label = "led_3";
  other.state = TrackedPoint::TENTATIVE;
  const auto grey = find(builder.build(points, {}), "point", 3).color;
  EXPECT_EQ(grey.r, grey.b);
  other.label = "other";
  other.state = TrackedPoint::TRACKED;
  EXPECT_EQ(find(fresh.build(points, {}), "point", 3).color,
            find(builder.build(points, {}), "point", 3).color);
}

TEST(Markers, AskWhetherADoubtfulLabelIsRight) {
  const Rig rig = threeCameras();
  MarkerBuilder builder({});
  builder.setRig(rig);
  auto points = messageOf(someSnapshot(rig), rig);
  points.points[0].label_confidence = 0.9f;
  EXPECT_EQ("led", find(builder.build(points, {}), "label", 0).text);
  points.points[0].label_confidence = 0.7f;
  EXPECT_EQ("led?", find(builder.build(points, {}), "label", 0).text);
}

TEST(Markers, DrawTheHeightAboveTheSquareAndAShadowOnIt) {
  Rig rig = threeCameras();
  rig.square_sides.clear();
  MarkerBuilder builder({});
  builder.setRig(rig);
  for (const char* ns : {"height", "shadow"})
    EXPECT_EQ(Marker::DELETE, find(draw(&builder, someSnapshot(rig), rig), ns, 0).action);
  rig.square_sides = {2.0, 3.0};
  builder.setRig(rig);
  const MarkerArray array = draw(&builder, someSnapshot(rig), rig);
  const Vector3d below(kLed.x(), kLed.y(), 0.0);
  const Marker height = find(array, "height", 0);
  EXPECT_EQ(kLed, vectorOf(height.points.at(0)));
  EXPECT_EQ(below, vectorOf(height.points.at(1)));
  EXPECT_EQ(below, vectorOf(find(array, "shadow", 0).points.at(0)));
}

TEST(Markers, ComeAtTheirRateAndStartOverWithTime) {
  const Rig rig = threeCameras();
  MarkerOptions options;
  options.rate = 10.0;
  MarkerBuilder builder(options);
  builder.setRig(rig);
  EXPECT_TRUE(builder.isDue(100.0));
  draw(&builder, someSnapshot(rig, 100.0), rig);
  EXPECT_FALSE(builder.isDue(100.05));
  EXPECT_TRUE(builder.isDue(100.101));
  EXPECT_TRUE(builder.isDue(50.0));
}

}  // namespace
}  // namespace wiimote_tracker
