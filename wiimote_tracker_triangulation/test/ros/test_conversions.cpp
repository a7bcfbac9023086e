// Rigs as messages, and as the files that stock ROS tools read.
#include "geometry/full_rig.h"
#include "geometry/rotation.h"
#include "refusal_of.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/geometry/rig_file.h"
#include "wiimote_tracker_triangulation/ros/conversions.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <camera_calibration_parsers/parse_yml.h>
#include <gtest/gtest.h>
#include <ros/serialization.h>
#include <sensor_msgs/distortion_models.h>

#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <limits>

namespace wiimote_tracker {
namespace {

using geometry::Rig;
using geometry::test::correctedRig;
using geometry::test::fullRig;
using geometry::test::Random;
using wiimote_tracker_msgs::RigCalibration;

constexpr double kUnset = std::numeric_limits<double>::quiet_NaN();

TEST(Conversions, MessageEqualsTheRig) {
  const Rig rig = fullRig(3);
  const RigCalibration message = toMessage(rig);
  EXPECT_EQ("world", message.header.frame_id);
  EXPECT_EQ(1766188800u, message.header.stamp.sec);
  EXPECT_EQ(1u, message.format_version);
  EXPECT_EQ(rig.id(), message.id);
  EXPECT_EQ(rig.method, message.method);
  EXPECT_EQ(RigCalibration::RAY_MODEL_IMAGE_CENTER, message.ray_model);
  EXPECT_EQ(rig.virtual_hfov, message.virtual_hfov);
  EXPECT_EQ((std::vector<double>{2.5, 1.0 / 3.0}), message.square_sides);
  EXPECT_EQ(0.1, message.led_height);
  EXPECT_EQ(rig.verdict, message.verdict);
  ASSERT_EQ(48u * 48u, message.covariance.size());
  ASSERT_NE(rig.covariance(2, 1), rig.covariance(1, 2));
  EXPECT_EQ(rig.covariance(2, 1), message.covariance[2 * 48 + 1]) << "row-major";
  ASSERT_EQ(1u, message.zones.size());
  EXPECT_EQ("hall", message.zones[0].name);
  EXPECT_EQ(3.0, message.zones[0].maximum.z);
  EXPECT_EQ("", message.remap.rig_id);

  ASSERT_EQ(3u, message.cameras.size());
  const wiimote_tracker_msgs::CameraCalibration& camera = message.cameras[0];
  const geometry::Intrinsics& intrinsics = rig.cameras[0].camera.intrinsics;
  EXPECT_EQ("camera_0", camera.name);
  EXPECT_EQ("00:00:00:00:00:00", camera.identity);
  EXPECT_EQ("camera_0_optical_frame", camera.frame_id);
  EXPECT_EQ(static_cast<std::uint32_t>(intrinsics.width), camera.width);
  EXPECT_EQ(static_cast<std::uint32_t>(intrinsics.height), camera.height);
  EXPECT_EQ("plumb_bob", camera.distortion_model);
  EXPECT_EQ(intrinsics.fx, camera.fx);
  EXPECT_EQ(intrinsics.fy, camera.fy);
  EXPECT_EQ(intrinsics.cx, camera.cx);
  EXPECT_EQ(intrinsics.cy, camera.cy);
  ASSERT_EQ(5u, camera.distortion.size());
  EXPECT_EQ(intrinsics.distortion[2], camera.distortion[2]);
  EXPECT_EQ(-1.0 / 300.0, camera.time_offset);
  EXPECT_EQ(wiimote_tracker_msgs::CameraCalibration::TIME_OFFSET_ONE_EPOCH,
            camera.time_offset_rule);
  EXPECT_EQ(4294967295u, camera.time_offset_epoch);
  EXPECT_EQ((std::vector<double>{0.1, -9.8, 1.0 / 3.0}), camera.gravity);
  ASSERT_EQ(2u, camera.masks.size());
  EXPECT_EQ(12.5, camera.masks[0].radius);
  EXPECT_EQ(0.1 + 0.2, camera.residual_px);
  EXPECT_EQ(120u, camera.observations);
  EXPECT_EQ(119u, camera.inliers);
  EXPECT_TRUE(message.cameras[1].gravity.empty());
  EXPECT_TRUE(std::isnan(message.cameras[1].time_offset));
}

TEST(Conversions, RoundTripsThroughMessageAndFileKeepIdAndBits) {
  const std::string path = "/tmp/conversions_" + std::to_string(getpid()) + ".yaml";
  Random random(62);
  for (int i = 0; i < 20; ++i) {
    const Rig rig = i == 0   ? fullRig()
                    : i == 1 ? correctedRig()
                             : geometry::test::randomRig(random, 4);
    const RigCalibration message = toMessage(rig);
    const Rig from_message = fromMessage(message);
    geometry::writeRigFile(from_message, path);
    const Rig from_file = geometry::readRigFile(path);
    EXPECT_EQ(message.id, from_message.id());
    EXPECT_EQ(message.id, from_file.id());
    const RigCalibration again = toMessage(from_file);
    // All of the message, byte by byte.
    const auto a = ros::serialization::serializeMessage(message);
    const auto b = ros::serialization::serializeMessage(again);
    ASSERT_EQ(a.num_bytes, b.num_bytes);
    EXPECT_EQ(0, std::memcmp(a.buf.get(), b.buf.get(), a.num_bytes));
  }
  std::filesystem::remove(path);
  std::filesystem::remove(path + ".bak");
}

TEST(Conversions, AWideLensHasFourCoefficientsAlsoInTheCovariance) {
  Rig rig = correctedRig(3);
  rig.covariance(1, 2) = 1e-9;
  rig.covariance(31, 32) = 2e-9;  // time offset of the wide one, rotation of the third
  rig.covariance(29, 31) = 3e-9;  // k4 of the wide one
  const RigCalibration message = toMessage(rig);
  EXPECT_EQ("equidistant", message.cameras[1].distortion_model);
  EXPECT_EQ(4u, message.cameras[1].distortion.size());
  ASSERT_EQ(47u * 47u, message.covariance.size());
  EXPECT_EQ(1e-9, message.covariance[1 * 47 + 2]);
  EXPECT_EQ(2e-9, message.covariance[30 * 47 + 31]);
  EXPECT_EQ(3e-9, message.covariance[29 * 47 + 30]);
}

TEST(Conversions, ACorrectionOfTheVolumeIsInTheMessage) {
  const Rig rig = correctedRig();
  const RigCalibration message = toMessage(rig);
  EXPECT_EQ(rig.id(), message.id);
  EXPECT_EQ(rig.id(), message.remap.rig_id);
  EXPECT_EQ("thin_plate", message.remap.model);
  EXPECT_EQ(30u, message.remap.parameters.size());
  ASSERT_EQ(6u, message.remap.support.size());
  EXPECT_EQ(rig.remap->support[3].y(), message.remap.support[3].y);
  const Rig back = fromMessage(message);
  ASSERT_TRUE(back.remap);
  EXPECT_EQ(rig.remap->support, back.remap->support);
  EXPECT_EQ(rig.covariance, back.covariance);

  RigCalibration damaged = message;
  damaged.remap.parameters.pop_back();
  EXPECT_THROW(fromMessage(damaged), geometry::Error);
  damaged = message;
  damaged.remap.model = "rubber";
  EXPECT_THROW(fromMessage(damaged), geometry::Error);
}

TEST(Conversions, RefusesInvalidMessages) {
  const auto complaint = [](const std::function<void(RigCalibration&)>& change) -> std::string {
    RigCalibration message = toMessage(fullRig());
    change(message);
    return refusalOf([&] { fromMessage(message); });
  };
  const auto says = [&](const std::function<void(RigCalibration&)>& change,
                        const std::string& words) {
    const std::string text = complaint(change);
    return text.find(words) != std::string::npos;
  };
  EXPECT_EQ("not refused", complaint([](RigCalibration&) {}));
  EXPECT_TRUE(says([](RigCalibration& m) { m.format_version = 2; }, "format version 2"));
  EXPECT_TRUE(says([](RigCalibration& m) { m.ray_model = 2; }, "ray model"));
  EXPECT_TRUE(says(
      [](RigCalibration& m) {
        m.cameras.clear();
        m.covariance.clear();
      },
      "no camera"));
  EXPECT_TRUE(says([](RigCalibration& m) { m.header.frame_id = ""; }, "world frame"));
  EXPECT_TRUE(
      says([](RigCalibration& m) { m.cameras[1].distortion_model = "equidistant"; }, "camera_1"));
  EXPECT_TRUE(says([](RigCalibration& m) { m.cameras[1].distortion.pop_back(); }, "camera_1"));
  EXPECT_TRUE(says([](RigCalibration& m) { m.cameras[0].gravity.pop_back(); }, "gravity"));
  EXPECT_TRUE(says([](RigCalibration& m) { m.cameras[1].time_offset_rule = 9; }, "camera_1"));
  EXPECT_TRUE(says([](RigCalibration& m) { m.cameras[1].fx = kUnset; }, "fx"));
  EXPECT_TRUE(says([](RigCalibration& m) { m.cameras[1].width = 0; }, "width"));
  EXPECT_TRUE(says([](RigCalibration& m) { m.cameras[1].width = 4294967295u; }, "width"));
  EXPECT_TRUE(says([](RigCalibration& m) { m.cameras[1].world_from_camera.position.x = kUnset; },
                   "camera_1"));
  EXPECT_TRUE(says([](RigCalibration& m) { m.cameras[1].world_from_camera.orientation.w += 0.1; },
                   "quaternion"));
  EXPECT_TRUE(says([](RigCalibration& m) { m.cameras[1].name = "camera_0"; }, "two cameras"));
  EXPECT_TRUE(says([](RigCalibration& m) { m.covariance.pop_back(); }, "covariance"));
}

TEST(Conversions, StaticTransformsAreThePoses) {
  const Rig rig = fullRig(3);
  const auto transforms = staticTransforms(rig);
  ASSERT_EQ(3u, transforms.size());
  for (std::size_t i = 0; i < 3; ++i) {
    const geometry_msgs::TransformStamped& t = transforms[i];
    EXPECT_EQ("world", t.header.frame_id);
    EXPECT_EQ("camera_" + std::to_string(i) + "_optical_frame", t.child_frame_id);
    const Eigen::Quaterniond q = rotationOf(t.transform.rotation);
    const Eigen::Isometry3d& pose = rig.cameras[i].camera.world_from_camera;
    EXPECT_TRUE(q.toRotationMatrix().isApprox(pose.linear(), 1e-12));
    EXPECT_EQ(pose.translation().y(), t.transform.translation.y);
  }
}

TEST(CameraInfoFile, OfAWideLensIsReadByCameraCalibrationParsers) {
  Random random(64);
  geometry::Camera camera;
  camera.name = "wiimote_1";
  camera.intrinsics = geometry::test::randomFisheye(random);
  const std::string path = "/tmp/camera_info_wide_" + std::to_string(getpid()) + ".yaml";
  geometry::writeCameraInfoFile(camera, path);
  std::string name;
  sensor_msgs::CameraInfo info;
  ASSERT_TRUE(camera_calibration_parsers::readCalibrationYml(path, name, info));
  std::filesystem::remove(path);
  EXPECT_EQ(sensor_msgs::distortion_models::EQUIDISTANT, info.distortion_model);
  ASSERT_EQ(4u, info.D.size());
  EXPECT_EQ(camera.intrinsics.distortion[3], info.D[3]);
}

TEST(CameraInfoFile, IsReadByCameraCalibrationParsers) {
  const Rig rig = fullRig();
  geometry::Camera camera = rig.cameras[0].camera;
  camera.name = "/room/wiimote_1";
  const std::string path = "/tmp/camera_info_" + std::to_string(getpid()) + ".yaml";
  geometry::writeCameraInfoFile(camera, path);
  std::string name;
  sensor_msgs::CameraInfo info;
  ASSERT_TRUE(camera_calibration_parsers::readCalibrationYml(path, name, info));
  std::filesystem::remove(path);
  EXPECT_EQ("room_wiimote_1", name);
  EXPECT_EQ(static_cast<std::uint32_t>(camera.intrinsics.width), info.width);
  EXPECT_EQ(static_cast<std::uint32_t>(camera.intrinsics.height), info.height);
  EXPECT_EQ("plumb_bob", info.distortion_model);
  ASSERT_EQ(5u, info.D.size());
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(camera.intrinsics.distortion[i], info.D[i]);
  EXPECT_EQ(camera.intrinsics.fx, info.K[0]);
  EXPECT_EQ(camera.intrinsics.cx, info.K[2]);
  EXPECT_EQ(camera.intrinsics.fy, info.K[4]);
  EXPECT_EQ(camera.intrinsics.cy, info.K[5]);
  EXPECT_EQ(1.0, info.K[8]);
  EXPECT_EQ(1.0, info.R[0]);
  EXPECT_EQ(camera.intrinsics.fx, info.P[0]);
  EXPECT_EQ(camera.intrinsics.cy, info.P[6]);
  EXPECT_EQ(0.0, info.P[3]);
}

}  // namespace
}  // namespace wiimote_tracker
