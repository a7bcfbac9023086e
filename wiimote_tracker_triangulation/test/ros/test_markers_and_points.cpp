// What rviz and the consumers of points get to see of an instant.
#include "geometry/random_rigs.h"
#include "marker_builder.h"
#include "point_message.h"

#include <gtest/gtest.h>

#include <set>

namespace wiimote_tracker {
namespace {

using Eigen::Vector3d;
using geometry::Rig;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

const Vector3d kLed(0.1, 0.2, 0.3);

Rig threeCameras() {
  geometry::test::Random random(71);
  return geometry::test::randomRig(random, 3);
}

/// Cameras 0 and 1 see the LED, camera 2 does not.
fusion::Instant someInstant(const Rig& rig, double time = 100.0) {
  fusion::Instant instant;
  instant.time = time;
  instant.latest_arrival = time + 0.03;
  instant.skew = 0.004;
  instant.sightings.resize(3);
  for (int i = 0; i < 2; ++i)
    instant.sightings[i] = {rig.cameras[i].camera.project(kLed), true};
  instant.point = geometry::TriangulatedPoint{kLed, Eigen::Matrix3d::Zero(), 0.25};
  instant.point->covariance << 4e-6, 1e-6, 0.0, 1e-6, 9e-6, 0.0, 0.0, 0.0, 1e-6;
  instant.rays_used = 2;
  instant.rays_possible = 3;
  instant.last_observed = time - 0.001;
  return instant;
}

const Marker& find(const MarkerArray& array, const std::string& ns, int id) {
  for (const Marker& marker : array.markers) {
    if (marker.ns == ns && marker.id == id && marker.action != Marker::DELETEALL)
      return marker;
  }
  throw std::logic_error("no marker " + ns + " " + std::to_string(id));
}

Vector3d vectorOf(const geometry_msgs::Point& p) {
  return {p.x, p.y, p.z};
}

TEST(PointMessage, SaysWhatIsKnownAndNoMore) {
  const Rig rig = threeCameras();
  PointContext context{"led", "maximum_likelihood", "0123", 98.0};
  const auto message = pointMessage(someInstant(rig), rig, 7, context);
  EXPECT_EQ(ros::Time(100.0), message.header.stamp);
  EXPECT_EQ("world", message.header.frame_id);
  EXPECT_EQ("0123", message.rig_id);
  EXPECT_EQ("maximum_likelihood", message.method);
  EXPECT_EQ(ros::Time(100.03), message.latest_arrival);
  EXPECT_EQ(0.004, message.skew);
  EXPECT_EQ(7u, message.late_frames);
  ASSERT_EQ(1u, message.points.size());
  const wiimote_tracker_msgs::TrackedPoint& point = message.points[0];
  EXPECT_EQ("led", point.label);
  EXPECT_EQ(wiimote_tracker_msgs::TrackedPoint::TRACKED, point.state);
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

TEST(PointMessage, IsEmptyWithoutAPoint) {
  const Rig rig = threeCameras();
  fusion::Instant instant = someInstant(rig);
  instant.point.reset();
  const auto message = pointMessage(instant, rig, 0, {"led", "m", "id", 0.0});
  EXPECT_TRUE(message.points.empty());
  EXPECT_EQ(ros::Time(100.0), message.header.stamp);
}

TEST(Markers, HaveUniqueNamesAndTheWorldFrame) {
  const Rig rig = threeCameras();
  MarkerBuilder builder({});
  builder.setRig(rig);
  const MarkerArray array = builder.build(someInstant(rig));
  ASSERT_FALSE(array.markers.empty());
  EXPECT_EQ(Marker::DELETEALL, array.markers[0].action) << "a new rig clears the old one";
  std::set<std::pair<std::string, int>> names;
  for (std::size_t i = 1; i < array.markers.size(); ++i) {
    const Marker& marker = array.markers[i];
    EXPECT_TRUE(names.insert({marker.ns, marker.id}).second) << marker.ns << " " << marker.id;
    EXPECT_EQ("world", marker.header.frame_id);
    EXPECT_EQ(ros::Time(100.0), marker.header.stamp);
    EXPECT_GT(marker.lifetime.toSec(), 0.0);
    if (marker.action == Marker::ADD && marker.type == Marker::SPHERE) {
      EXPECT_GT(std::min({marker.scale.x, marker.scale.y, marker.scale.z}), 0.0);
    }
  }
  const MarkerArray next = builder.build(someInstant(rig, 100.1));
  EXPECT_NE(Marker::DELETEALL, next.markers[0].action);
}

TEST(Markers, ShowWhereTheCamerasLook) {
  const Rig rig = threeCameras();
  MarkerOptions options;
  options.image_plane_distance = 0.7;
  MarkerBuilder builder(options);
  builder.setRig(rig);
  const MarkerArray array = builder.build(someInstant(rig));
  for (int i = 0; i < 3; ++i) {
    const geometry::Camera& camera = rig.cameras[i].camera;
    const Marker& plane = find(array, "image_plane", i);
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
  }
}

TEST(Markers, RaysGoFromTheCameraThroughItsBlobToThePoint) {
  const Rig rig = threeCameras();
  MarkerBuilder builder({});
  builder.setRig(rig);
  const MarkerArray array = builder.build(someInstant(rig));
  for (int i = 0; i < 2; ++i) {
    const Marker& ray = find(array, "ray", i);
    ASSERT_EQ(2u, ray.points.size());
    const Vector3d from = vectorOf(ray.points[0]);
    const Vector3d to = vectorOf(ray.points[1]);
    EXPECT_LT((from - rig.cameras[i].camera.center()).norm(), 1e-12);
    EXPECT_LT((to - kLed).norm(), 1e-9);
    const Vector3d blob = vectorOf(find(array, "blob", i).pose.position);
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
  const fusion::Instant instant = someInstant(rig);
  const Marker ellipsoid = find(builder.build(instant), "covariance", 0);
  const Eigen::Quaterniond q(ellipsoid.pose.orientation.w, ellipsoid.pose.orientation.x,
                             ellipsoid.pose.orientation.y, ellipsoid.pose.orientation.z);
  EXPECT_NEAR(1.0, q.norm(), 1e-12);
  // Draw errors with that covariance; count how many fall into the drawn body.
  geometry::test::Random random(72);
  const Eigen::Matrix3d L = instant.point->covariance.llt().matrixL();
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

TEST(Markers, ALostPointIsTakenAwayAndTheTrailFades) {
  const Rig rig = threeCameras();
  MarkerOptions options;
  options.trail_duration = 1.0;
  MarkerBuilder builder(options);
  builder.setRig(rig);
  MarkerArray array;
  for (int i = 0; i < 40; ++i)
    array = builder.build(someInstant(rig, 100.0 + 0.05 * i));
  EXPECT_NEAR(21.0, static_cast<double>(find(array, "trail", 0).points.size()), 1.0);
  fusion::Instant lost = someInstant(rig, 105.0);
  lost.point.reset();
  lost.sightings.assign(3, {});
  array = builder.build(lost);
  for (const std::string ns : {"point", "covariance", "trail"})
    EXPECT_EQ(Marker::DELETE, find(array, ns, 0).action) << ns;
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(Marker::DELETE, find(array, "ray", i).action);
}

TEST(Markers, ComeAtTheirRateAndStartOverWithTime) {
  const Rig rig = threeCameras();
  MarkerOptions options;
  options.rate = 10.0;
  MarkerBuilder builder(options);
  builder.setRig(rig);
  EXPECT_TRUE(builder.isDue(100.0));
  builder.build(someInstant(rig, 100.0));
  EXPECT_FALSE(builder.isDue(100.05));
  EXPECT_TRUE(builder.isDue(100.101));
  EXPECT_TRUE(builder.isDue(50.0));
}

}  // namespace
}  // namespace wiimote_tracker
