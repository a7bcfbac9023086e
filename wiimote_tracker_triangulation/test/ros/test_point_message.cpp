// Point messages of a snapshot, and the correction of the volume before them.
#include "seen_led.h"

#include "ros/tracker/point_message.h"
#include "ros/tracker/volume_correction.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <gtest/gtest.h>

namespace wiimote_tracker {
namespace {

using Eigen::Vector3d;
using geometry::Rig;
using tracking::Snapshot;
using tracking::TrackedLed;
using tracking::TrackState;
using wiimote_tracker_msgs::TrackedPoint;

TEST(PointMessage, HoldsOnlyKnownValues) {
  const Rig rig = threeCameras();
  const auto message = messageOf(someSnapshot(rig), rig);
  EXPECT_EQ(ros::Time(100.0), message.header.stamp);
  EXPECT_EQ("world", message.header.frame_id);
  EXPECT_EQ(ros::Time(100.03), message.latest_arrival);
  EXPECT_EQ(0.004, message.skew);
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
  Snapshot snapshot = someSnapshot(rig);
  snapshot.leds.push_back(someLed(4, 100.0, {1.0, 0.0, 0.0}));
  TrackedLed& second = snapshot.leds[1];
  second.state = TrackState::kPredicted;
  second.remapped = true;
  second.velocity = Vector3d(1.0, 2.0, 3.0);
  second.velocity_covariance = Vector3d(4.0, 5.0, 6.0).asDiagonal();
  const auto message = messageOf(snapshot, rig);
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
  Snapshot snapshot = someSnapshot(rig);
  snapshot.leds.clear();
  const auto message = messageOf(snapshot, rig);
  EXPECT_TRUE(message.points.empty());
  EXPECT_EQ(ros::Time(100.0), message.header.stamp);
}

TEST(PointMessage, OnlyObservedLedsHaveAPosition) {
  TrackedPoint point;
  for (const bool publish_predicted : {false, true}) {
    point.state = TrackedPoint::TENTATIVE;
    EXPECT_FALSE(isPublished(point, publish_predicted));
    point.state = TrackedPoint::TRACKED;
    EXPECT_TRUE(isPublished(point, publish_predicted));
    point.state = TrackedPoint::PREDICTED;
    EXPECT_EQ(publish_predicted, isPublished(point, publish_predicted));
    point.state = TrackedPoint::LOST;
    EXPECT_FALSE(isPublished(point, publish_predicted));
  }
}

TEST(VolumeCorrection, MovesPositionsAndVelocitiesAndTheirCovariances) {
  Rig rig = threeCameras();
  rig.remap = remap::Remap{rig.id(), remap::Model::kAffine, std::vector<double>(12, 0.0), {}};
  rig.remap->parameters[2] = 0.1;  // upwards
  rig.remap->parameters[3] = 0.5;  // along x, the more the further
  for (int corner = 0; corner < 8; ++corner)
    rig.remap->support.emplace_back(corner % 2 ? 1.0 : -1.0, corner / 2 % 2 ? 1.0 : -1.0,
                                    corner / 4 ? 1.0 : -1.0);
  VolumeCorrection correction;
  EXPECT_TRUE(correction.take(rig));
  const auto corrected = [&](Snapshot snapshot) {
    correction.apply(&snapshot);
    return snapshot.leds;
  };
  Snapshot raw = someSnapshot(rig);
  raw.leds.push_back(someLed(1, 100.0, {0.0, 0.0, 5.0}));
  raw.leds[0].velocity = Vector3d(1.0, 2.0, 3.0);
  raw.leds[0].velocity_covariance.setIdentity();
  const std::vector<TrackedLed> leds = corrected(raw);
  ASSERT_EQ(2u, leds.size());
  EXPECT_TRUE(leds[0].remapped);
  EXPECT_FALSE(leds[1].remapped);
  // The velocity matches differences of corrected positions.
  constexpr double kStep = 1e-6;
  Snapshot later = raw;
  later.leds[0].position += kStep * *raw.leds[0].velocity;
  const Vector3d expected = (corrected(later)[0].position - leds[0].position) / kStep;
  EXPECT_LT((*leds[0].velocity - expected).norm(), 1e-6);
  EXPECT_GT((expected - *raw.leds[0].velocity).norm(), 0.1);
  EXPECT_NEAR(kLed.z() + 0.1, leds[0].position.z(), 1e-9);
  // So do both covariances.
  Eigen::Matrix3d jacobian;
  for (int axis = 0; axis < 3; ++axis) {
    Snapshot moved = raw;
    moved.leds[0].position += kStep * Vector3d::Unit(axis);
    jacobian.col(axis) = (corrected(moved)[0].position - leds[0].position) / kStep;
  }
  const TrackedLed& led = leds[0];
  EXPECT_LT((led.velocity_covariance - jacobian * jacobian.transpose()).norm(), 1e-6);
  EXPECT_GT((led.velocity_covariance - Eigen::Matrix3d::Identity()).norm(), 0.1);
  const Eigen::Matrix3d covariance =
      jacobian * raw.leds[0].position_covariance * jacobian.transpose();
  EXPECT_LT((led.position_covariance - covariance).norm(), 1e-6 * covariance.norm());
}

}  // namespace
}  // namespace wiimote_tracker
