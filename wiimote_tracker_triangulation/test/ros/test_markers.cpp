// Markers of a snapshot.
#include "seen_led.h"

#include "geometry/gaussian.h"
#include "ros/marker_builder.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace wiimote_tracker {
namespace {

using Eigen::Vector3d;
using geometry::Rig;
using tracking::TrackState;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;
using wiimote_tracker_msgs::TrackedPoint;

/// Three cameras, of which two see an LED.
class Markers : public testing::Test {
 protected:
  Markers() { use({}); }

  void use(const MarkerOptions& options) {
    builder_ = MarkerBuilder(options);
    builder_.setRig(rig_);
  }

  MarkerArray draw(const tracking::Snapshot& snapshot) {
    return builder_.build(messageOf(snapshot, rig_), snapshot.views);
  }

  Rig rig_ = threeCameras();
  tracking::Snapshot seen_ = someSnapshot(rig_);
  MarkerBuilder builder_{MarkerOptions()};
};

const Marker& find(const MarkerArray& array, const std::string& ns, int id) {
  for (const Marker& marker : array.markers) {
    if (marker.ns == ns && marker.id == id && marker.action != Marker::DELETEALL)
      return marker;
  }
  throw std::logic_error("no marker " + ns + " " + std::to_string(id));
}

std::size_t numberOfRays(const MarkerArray& array, int action = Marker::ADD) {
  return static_cast<std::size_t>(std::count_if(
      array.markers.begin(), array.markers.end(),
      [&](const Marker& marker) { return marker.ns == "ray" && marker.action == action; }));
}

TEST_F(Markers, HaveUniqueNamesAndTheWorldFrame) {
  const MarkerArray array = draw(seen_);
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
  const MarkerArray next = draw(someSnapshot(rig_, 100.1));
  EXPECT_NE(Marker::DELETEALL, next.markers[0].action);
}

TEST_F(Markers, ShowWhereTheCamerasLook) {
  MarkerOptions options;
  options.image_plane_distance = 0.7;
  use(options);
  const MarkerArray array = draw(seen_);
  for (int i = 0; i < 3; ++i) {
    const geometry::Camera& camera = rig_.cameras[i].camera;
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
    EXPECT_TRUE((rotationOf(housing.pose.orientation) * Vector3d::UnitZ())
                    .isApprox(camera.world_from_camera.linear().col(2), 1e-12));
  }
}

TEST_F(Markers, RaysGoFromTheCameraThroughItsBlobToThePoint) {
  const MarkerArray array = draw(seen_);
  for (int i = 0; i < 2; ++i) {
    const Marker ray = find(array, "ray", i);
    ASSERT_EQ(2u, ray.points.size());
    const Vector3d from = vectorOf(ray.points[0]);
    const Vector3d to = vectorOf(ray.points[1]);
    EXPECT_LT((from - rig_.cameras[i].camera.center()).norm(), 1e-12);
    EXPECT_LT((to - kLed).norm(), 1e-9);
    const Vector3d blob = vectorOf(find(array, "blob", i).points.at(0));
    EXPECT_LT((blob - from).cross(to - from).norm(), 1e-9);
  }
  EXPECT_EQ(2u, numberOfRays(array));
  EXPECT_EQ(Marker::DELETE, find(array, "blob", 2).action);
  EXPECT_LT((vectorOf(find(array, "point", 0).pose.position) - kLed).norm(), 1e-12);
}

TEST_F(Markers, RaysArePalerAndThinnerTheLessIsKnownOfTheirLed) {
  std::vector<Marker> rays;
  for (const double stddev : {0.001, 0.004, 0.02, 0.1, std::nan("")}) {
    seen_.leds[0].position_covariance = stddev * stddev / 3.0 * Eigen::Matrix3d::Identity();
    rays.push_back(find(draw(seen_), "ray", 0));
  }
  for (const std::size_t same : {0, 3}) {
    EXPECT_EQ(rays[same].color.a, rays[same + 1].color.a);
    EXPECT_EQ(rays[same].scale.x, rays[same + 1].scale.x);
  }
  for (const std::size_t better : {1, 2}) {
    EXPECT_GT(rays[better].color.a, 1.5f * rays[better + 1].color.a);
    EXPECT_GT(rays[better].scale.x, 1.5 * rays[better + 1].scale.x);
  }
}

TEST_F(Markers, EllipsoidHolds95Percent) {
  const Marker ellipsoid = find(draw(seen_), "covariance", 0);
  const Eigen::Quaterniond q = rotationOf(ellipsoid.pose.orientation);
  EXPECT_NEAR(1.0, q.norm(), 1e-12);
  // Draw errors with that covariance; count how many fall into the drawn body.
  geometry::test::Random random(72);
  const Eigen::Matrix3d L = geometry::test::rootOf(seen_.leds[0].position_covariance);
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

TEST_F(Markers, ALostPointIsRemovedAndItsTrailFadesWithinHalfASecond) {
  MarkerOptions options;
  options.trail_duration = 1.0;
  use(options);
  MarkerArray array;
  for (int i = 0; i < 40; ++i)
    array = draw(someSnapshot(rig_, 100.0 + 0.05 * i));
  const Marker trail = find(array, "trail", 0);
  EXPECT_NEAR(21.0, static_cast<double>(trail.points.size()), 1.0);
  tracking::Snapshot lost = someSnapshot(rig_, 102.0);
  lost.leds[0].state = TrackState::kLost;
  for (tracking::CameraView& view : lost.views)
    view.spots.clear();
  array = draw(lost);
  for (const std::string ns : {"point", "covariance", "height", "shadow", "label"})
    EXPECT_EQ(Marker::DELETE, find(array, ns, 0).action) << ns;
  EXPECT_EQ(2u, numberOfRays(array, Marker::DELETE));
  EXPECT_EQ(0u, numberOfRays(array));
  EXPECT_EQ(Marker::ADD, find(array, "trail", 0).action);
  lost.leds.clear();
  lost.time = 102.2;
  EXPECT_LT(find(draw(lost), "trail", 0).color.a, 0.6f * trail.color.a);
  lost.time = 102.45;
  array = draw(lost);
  EXPECT_EQ(Marker::DELETE, find(array, "trail", 0).action);
}

TEST_F(Markers, EveryLedIsDrawnWithItsName) {
  seen_.leds.push_back(someLed(3, 100.0, {1.0, 0.0, 0.5}));
  seen_.leds[1].state = TrackState::kPredicted;
  MarkerArray array = draw(seen_);
  EXPECT_EQ("led", find(array, "label", 0).text);
  EXPECT_EQ("led_3", find(array, "label", 3).text);
  EXPECT_EQ(1.0, find(array, "point", 3).pose.position.x);
  EXPECT_LT(find(array, "point", 3).color.a, find(array, "point", 0).color.a)
      << "what is not seen is pale";
  EXPECT_EQ(Marker::ADD, find(array, "covariance", 3).action);
  // A point that vanishes without being reported lost is removed too.
  seen_.leds.pop_back();
  seen_.time = 100.1;
  array = draw(seen_);
  EXPECT_EQ(Marker::DELETE, find(array, "point", 3).action);
  EXPECT_EQ(Marker::ADD, find(array, "point", 0).action);
}

TEST_F(Markers, OfTheSameCamerasStayWhenTheRigIsAdjusted) {
  draw(seen_);
  rig_.cameras[0].camera.world_from_camera.pretranslate(Vector3d(0.0001, 0.0, 0.0));
  builder_.setRig(rig_);
  seen_.time += 0.1;
  const MarkerArray array = draw(seen_);
  for (const Marker& marker : array.markers)
    EXPECT_NE(Marker::DELETEALL, marker.action);
  EXPECT_EQ(2u, find(array, "trail", 0).points.size());

  rig_.world_frame = "room";
  builder_.setRig(rig_);
  EXPECT_EQ(Marker::DELETEALL, draw(seen_).markers[0].action);
}

TEST_F(Markers, ShowMaskedAndUnassignedSpots) {
  rig_.cameras[0].masks = {{{300.0, 200.0}, 25.0}};
  builder_.setRig(rig_);
  seen_.views[0].spots.push_back({{310.0, 200.0}, tracking::SpotUse::kMasked, 0});
  seen_.views[0].spots.push_back({{500.0, 300.0}, tracking::SpotUse::kUnassigned, 0});
  const MarkerArray array = draw(seen_);
  const Marker mask = find(array, "mask", 0);
  ASSERT_FALSE(mask.points.empty());
  for (const auto& p : mask.points) {
    const auto pixel = rig_.cameras[0].camera.project(vectorOf(p));
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
  EXPECT_EQ(3u, numberOfRays(array)) << "none of the masked spot";
  seen_.views[0].spots.clear();
  EXPECT_EQ(2u, numberOfRays(draw(seen_), Marker::DELETE));
}

TEST_F(Markers, OldSpotsAreNotDrawn) {
  seen_.views[1].time = 98.0;
  const MarkerArray array = draw(seen_);
  EXPECT_EQ(Marker::ADD, find(array, "ray", 0).action);
  EXPECT_EQ(1u, numberOfRays(array));
}

TEST_F(Markers, ACameraWithoutImagesIsGreyAndSaysSo) {
  seen_.views[1].time = 99.2;
  seen_.views[2].time.reset();
  const MarkerArray array = draw(seen_);
  EXPECT_EQ("camera_0", find(array, "camera", 0).text);
  for (int i = 1; i < 3; ++i) {
    EXPECT_EQ(rig_.cameras[i].camera.name + ": no images", find(array, "camera", i).text);
    const auto& color = find(array, "frustum", i).color;
    EXPECT_EQ(color.r, color.b) << "grey";
  }
}

TEST_F(Markers, ALabelKeepsItsColourOnAnotherTrack) {
  auto points = messageOf(seen_, rig_);
  const MarkerArray before = builder_.build(points, {});
  points.points[0].id = 7;
  const MarkerArray after = builder_.build(points, {});
  EXPECT_EQ(find(before, "point", 0).color, find(after, "point", 7).color);
}

TEST_F(Markers, TentativeLedsUseUpNoColours) {
  MarkerBuilder fresh({});
  fresh.setRig(rig_);
  auto points = messageOf(seen_, rig_);
  points.points.resize(2, points.points[0]);
  TrackedPoint& other = points.points[1];
  other.id = 3;
  other.label = "led_3";
  other.state = TrackedPoint::TENTATIVE;
  const auto grey = find(builder_.build(points, {}), "point", 3).color;
  EXPECT_EQ(grey.r, grey.b);
  other.label = "other";
  other.state = TrackedPoint::TRACKED;
  EXPECT_EQ(find(fresh.build(points, {}), "point", 3).color,
            find(builder_.build(points, {}), "point", 3).color);
}

TEST_F(Markers, AskWhetherADoubtfulLabelIsRight) {
  auto points = messageOf(seen_, rig_);
  points.points[0].label_confidence = 0.9f;
  EXPECT_EQ("led", find(builder_.build(points, {}), "label", 0).text);
  points.points[0].label_confidence = 0.7f;
  EXPECT_EQ("led?", find(builder_.build(points, {}), "label", 0).text);
}

TEST_F(Markers, DrawTheHeightAboveTheSquareAndAShadowOnIt) {
  rig_.square_sides.clear();
  builder_.setRig(rig_);
  for (const char* ns : {"height", "shadow"})
    EXPECT_EQ(Marker::DELETE, find(draw(seen_), ns, 0).action);
  rig_.square_sides = {2.0, 3.0};
  builder_.setRig(rig_);
  const MarkerArray array = draw(seen_);
  const Vector3d below(kLed.x(), kLed.y(), 0.0);
  const Marker height = find(array, "height", 0);
  EXPECT_EQ(kLed, vectorOf(height.points.at(0)));
  EXPECT_EQ(below, vectorOf(height.points.at(1)));
  EXPECT_EQ(below, vectorOf(find(array, "shadow", 0).points.at(0)));
}

TEST_F(Markers, ComeAtTheirRateAndStartOverWithTime) {
  MarkerOptions options;
  options.rate = 10.0;
  use(options);
  EXPECT_TRUE(builder_.isDue(100.0));
  draw(someSnapshot(rig_, 100.0));
  EXPECT_FALSE(builder_.isDue(100.05));
  EXPECT_TRUE(builder_.isDue(100.101));
  EXPECT_TRUE(builder_.isDue(50.0));
}

}  // namespace
}  // namespace wiimote_tracker
