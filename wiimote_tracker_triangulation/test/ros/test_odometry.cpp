// Odometry and twist of bodies and LEDs from the tracker's messages.
#include "geometry/gaussian.h"
#include "geometry/random_rigs.h"
#include "ros/tracker/publish_each.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace wiimote_tracker {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using geometry::test::Random;
using wiimote_tracker_msgs::TrackedBody;
using wiimote_tracker_msgs::TrackedBodyArray;
using wiimote_tracker_msgs::TrackedPoint;
using wiimote_tracker_msgs::TrackedPointArray;
using Matrix6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

Matrix6 someCovariance(Random& random, double stddev) {
  Matrix6 root = Matrix6::Identity();
  for (Eigen::Index i = 0; i < 36; ++i)
    root(i / 6, i % 6) += 0.3 * random.gaussian();
  return stddev * stddev * root * root.transpose();
}

TrackedBodyArray arrayOf(const TrackedBody& body) {
  TrackedBodyArray array;
  array.header.frame_id = "world";
  array.header.stamp = ros::Time(12, 34);
  array.bodies = {body};
  return array;
}

TrackedBody moving(const Eigen::Quaterniond& rotation, const Vector3d& v, const Vector3d& w) {
  TrackedBody body;
  body.name = "wand";
  setRotation(rotation, &body.pose.pose.orientation);
  setVector(v, &body.twist.twist.linear);
  setVector(w, &body.twist.twist.angular);
  return body;
}

TEST(BodyOdometry, TheTwistIsAlongTheBodysAxes) {
  // Turned by 90 degrees about z, the world's x is the body's -y.
  TrackedBody body = moving(Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ())),
                            {1.0, 2.0, 3.0}, {0.1, 0.2, 0.3});
  body.pose.pose.position.x = 7.0;
  const TrackedBodyArray array = arrayOf(body);
  const nav_msgs::Odometry found = odometry(array, body);
  EXPECT_EQ("world", found.header.frame_id);
  EXPECT_EQ("wand", found.child_frame_id);
  EXPECT_EQ(array.header.stamp, found.header.stamp);
  EXPECT_EQ(body.pose, found.pose);
  EXPECT_LT((vectorOf(found.twist.twist.linear) - Vector3d(2.0, -1.0, 3.0)).norm(), 1e-12);
  EXPECT_LT((vectorOf(found.twist.twist.angular) - Vector3d(0.2, -0.1, 0.3)).norm(), 1e-12);
  const geometry_msgs::TwistWithCovarianceStamped twist = twistStamped(found);
  EXPECT_EQ("wand", twist.header.frame_id);
  EXPECT_EQ(found.twist, twist.twist);
}

TEST(BodyOdometry, TheCovarianceIsTheSpreadOfTwists) {
  Random random(61);
  const Eigen::Quaterniond rotation(
      Eigen::AngleAxisd(0.8, Vector3d(0.6, 0.0, 0.8)).toRotationMatrix());
  const Vector3d v(1.5, -0.5, 0.7);
  const Vector3d w(2.0, 1.0, -3.0);
  TrackedBody body = moving(rotation, v, w);
  setMatrix(someCovariance(random, 0.02), &body.pose.covariance);
  setMatrix(someCovariance(random, 0.03), &body.twist.covariance);
  const Eigen::Map<const Matrix6> pose(body.pose.covariance.data());
  const Eigen::Map<const Matrix6> in_world(body.twist.covariance.data());
  const Matrix3d rotation_root = geometry::test::rootOf(pose.bottomRightCorner<3, 3>());
  const Matrix6 twist_root = geometry::test::rootOf(in_world);
  const geometry_msgs::TwistWithCovariance stated = odometry(arrayOf(body), body).twist;
  Vector6 mean;
  mean << vectorOf(stated.twist.linear), vectorOf(stated.twist.angular);
  Matrix6 spread = Matrix6::Zero();
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) {
    // A true orientation and twist, as they may be.
    const Vector3d turn = rotation_root * random.gaussianVector(1.0);
    const Matrix3d truth =
        Eigen::AngleAxisd(turn.norm(), turn.normalized()) * rotation.toRotationMatrix();
    Vector6 z;
    z << random.gaussianVector(1.0), random.gaussianVector(1.0);
    Vector6 twist;
    twist << v, w;
    twist += twist_root * z;
    Vector6 error;
    error << truth.transpose() * twist.head<3>(), truth.transpose() * twist.tail<3>();
    error -= mean;
    spread += error * error.transpose() / kDraws;
  }
  const Matrix6 covariance = Eigen::Map<const Matrix6>(stated.covariance.data());
  EXPECT_LT(geometry::test::whitenedDifference(spread, covariance), 0.05);
}

TEST(LedOdometry, WhatIsUnknownHasALargeVariance) {
  TrackedPoint point;
  point.label = "left";
  point.position.y = 2.0;
  point.velocity.x = 0.5;
  setMatrix(Matrix3d(4e-6 * Matrix3d::Identity()), &point.position_covariance);
  setMatrix(Matrix3d(9e-4 * Matrix3d::Identity()), &point.velocity_covariance);
  TrackedPointArray array;
  array.header.frame_id = "world";
  for (const bool has_velocity : {true, false}) {
    if (!has_velocity) {
      point.velocity.x = std::numeric_limits<double>::quiet_NaN();
      point.velocity_covariance.assign(std::numeric_limits<double>::quiet_NaN());
    }
    const nav_msgs::Odometry found = odometry(array, point);
    EXPECT_EQ("left", found.child_frame_id);
    EXPECT_EQ(2.0, found.pose.pose.position.y);
    EXPECT_EQ(1.0, found.pose.pose.orientation.w);
    EXPECT_EQ(4e-6, found.pose.covariance[7]);
    EXPECT_EQ(kUnknownVariance, found.pose.covariance[35]);
    EXPECT_EQ(has_velocity ? 0.5 : 0.0, found.twist.twist.linear.x);
    EXPECT_EQ(has_velocity ? 9e-4 : kUnknownVariance, found.twist.covariance[0]);
    for (const auto& covariance : {found.pose.covariance, found.twist.covariance}) {
      const Matrix6 matrix = Eigen::Map<const Matrix6>(covariance.data());
      EXPECT_GT(geometry::test::leastEigenvalue(matrix), 0.0);
    }
  }
}

}  // namespace
}  // namespace wiimote_tracker
