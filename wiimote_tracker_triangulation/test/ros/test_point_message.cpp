// Point messages of a snapshot, and the correction of the volume before them.
#include "seen_led.h"

#include "ros/point_message.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <gtest/gtest.h>

namespace wiimote_tracker {
namespace {

using Eigen::Vector3d;
using geometry::Rig;
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
  // So do both covariances.
  Eigen::Matrix3d jacobian;
  for (int axis = 0; axis < 3; ++axis) {
    CorrectedSnapshot moved = raw;
    moved.snapshot.leds[0].position += kStep * Vector3d::Unit(axis);
    CorrectedSnapshot moved_corrected;
    correction.apply(moved.snapshot, &moved_corrected);
    jacobian.col(axis) =
        (moved_corrected.snapshot.leds[0].position - corrected.snapshot.leds[0].position) / kStep;
  }
  const TrackedLed& led = corrected.snapshot.leds[0];
  EXPECT_LT((led.velocity_covariance - jacobian * jacobian.transpose()).norm(), 1e-6);
  EXPECT_GT((led.velocity_covariance - Eigen::Matrix3d::Identity()).norm(), 0.1);
  const Eigen::Matrix3d covariance =
      jacobian * raw.snapshot.leds[0].position_covariance * jacobian.transpose();
  EXPECT_LT((led.position_covariance - covariance).norm(), 1e-6 * covariance.norm());
}

}  // namespace
}  // namespace wiimote_tracker
