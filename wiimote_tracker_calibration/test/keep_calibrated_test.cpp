// From a recording in which a camera was knocked to a rig with its new pose.

#include "expect_says.h"
#include "import_folder.h"
#include "run_command.h"
#include "waved_led.h"

#include <gtest/gtest.h>
#include <ros/time.h>
#include <rosbag/bag.h>
#include <sensor_msgs/Imu.h>
#include <tf2_msgs/TFMessage.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>
#include <wiimote_tracker_triangulation/geometry/rig_file.h>

#include <Eigen/Geometry>

#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker {
namespace {

constexpr std::size_t kKnocked = 1;
constexpr double kKnock = 20.0;  // [s]
constexpr double kEnd = 50.0;    // [s]

Eigen::Vector3d gravityOf(const geometry::RigCamera& camera) {
  return 9.81 * camera.camera.world_from_camera.linear().row(2).transpose();
}

class Recording {
 public:
  explicit Recording(const std::string& path) : bag_(path, rosbag::bagmode::Write) {}

  /// The axes of a Wii Remote: x left, y to the rear, z up.
  void writeFrames(const std::vector<geometry::RigCamera>& cameras) {
    tf2_msgs::TFMessage frames;
    for (const geometry::RigCamera& camera : cameras) {
      geometry_msgs::TransformStamped frame;
      frame.header.frame_id = camera.camera.name + "_optical_frame";
      frame.child_frame_id = camera.camera.name + "_imu_frame";
      frame.transform.rotation.y = -std::sqrt(0.5);
      frame.transform.rotation.z = std::sqrt(0.5);
      frames.transforms.push_back(frame);
    }
    bag_.write("/tf_static", ros::Time(WavedLed::kClock - 1.0), frames);
  }

  /// Each camera's images take another time to arrive, so that their order is not that of the
  /// stamps.
  void write(const capture::Image& image) {
    wiimote_tracker_msgs::IrBlobArray message;
    message.header.stamp.fromSec(image.stamp);
    message.header.frame_id = image.camera + "_optical_frame";
    message.camera = image.camera;
    message.clock_epoch = image.clock_epoch;
    message.width = 1024;
    message.height = 768;
    message.max_blobs = 4;
    for (const Eigen::Vector2d& spot : image.spots) {
      message.blobs.emplace_back();
      message.blobs.back().x = spot.x();
      message.blobs.back().y = spot.y();
    }
    const double delay =
        delays_.emplace(image.camera, 0.05 * static_cast<double>(delays_.size())).first->second;
    bag_.write("/room/" + image.camera + "/ir_blobs", ros::Time(image.stamp + delay), message);
  }

  void writeReading(const geometry::RigCamera& camera, double time) {
    const Eigen::Vector3d optical = gravityOf(camera);
    sensor_msgs::Imu imu;
    imu.header.stamp.fromSec(WavedLed::kClock + time);
    imu.header.frame_id = camera.camera.name + "_imu_frame";
    imu.linear_acceleration.x = -optical.x();
    imu.linear_acceleration.y = -optical.z();
    imu.linear_acceleration.z = -optical.y();
    bag_.write("/room/" + camera.camera.name + "/imu/data_raw", imu.header.stamp, imu);
  }

 private:
  rosbag::Bag bag_;
  std::map<std::string, double> delays_;  // [s]
};

TEST(KeepCalibrated, ReadsImagesInTheOrderOfTheirStampsAndAccelerometers) {
  square::Random random(1);
  const geometry::Rig rig = paperRigWith(wellCalibrated());
  import::Folder folder;
  for (const std::string name : {"in.bag", "rig.yaml", "rig.yaml.bak", "out.yaml", "out.yaml.bak"})
    folder.write(name, "");
  const auto at = [&](const std::string& name) { return folder.path() + "/" + name; };
  geometry::writeRigFile(rig, at("rig.yaml"));
  WavedLed led(drawTruth(rig, random), 100);
  {
    Recording recording(at("in.bag"));
    recording.writeFrames(led.truth);
    const auto write = [&](const capture::Image& image) { recording.write(image); };
    led.runUntil(kKnock, write);
    led.truth[kKnocked] = turned(led.truth[kKnocked], 2.0 * M_PI / 180.0, random);
    led.runUntil(kEnd, write);
    for (double time = kKnock; time < kEnd; time += 0.05) {
      for (const geometry::RigCamera& camera : led.truth)
        recording.writeReading(camera, time);
    }
  }
  const auto result = runCommand("rosrun wiimote_tracker_calibration keep_calibrated --rig " +
                                 at("rig.yaml") + " " + at("in.bag") + " " + at("out.yaml"));
  ASSERT_EQ(result.first, 0) << result.second;
  const geometry::Rig kept = geometry::readRigFile(at("out.yaml"));
  const geometry::RigCamera& truth = led.truth[kKnocked];
  EXPECT_SAYS(result.second, truth.camera.name + " was turned by");
  const geometry::RigCamera* const found = kept.find(truth.camera.name);
  ASSERT_TRUE(found != nullptr);
  const Eigen::Matrix3d turn = found->camera.world_from_camera.linear().transpose() *
                               truth.camera.world_from_camera.linear();
  EXPECT_LT(Eigen::AngleAxisd(turn).angle(), 0.2 * M_PI / 180.0);
  ASSERT_TRUE(found->gravity);
  EXPECT_LT((*found->gravity - gravityOf(truth)).norm(), 1e-3);
}

}  // namespace
}  // namespace wiimote_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
