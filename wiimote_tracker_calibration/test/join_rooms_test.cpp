// From the images of two rooms, recorded in one bag while an LED is carried from room to room, to
// one rig: track_bag for each room, then join_rooms.

#include "expect_says.h"
#include "import_folder.h"
#include "room_trial.h"
#include "run_command.h"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>
#include <wiimote_tracker_triangulation/geometry/rig_file.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace wiimote_tracker {
namespace {

/// All cameras take an image at each time of the walks, and a camera sees only its own room.
void recordImages(const TwoRooms& rooms, const std::string& path) {
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  const std::vector<geometry::RigCamera> cameras = rooms.trueCameras();
  for (std::size_t walk = 0; walk < rooms.walks.size(); ++walk) {
    for (const rooms::PathPoint& point : rooms.walks[walk]) {
      for (std::size_t i = 0; i < cameras.size(); ++i) {
        const geometry::RigCamera& camera = cameras[i];
        wiimote_tracker_msgs::IrBlobArray image;
        image.header.stamp.fromSec(point.time - camera.time_offset);
        image.arrival.fromSec(point.time + 0.005 + 0.0001 * static_cast<double>(i));
        image.camera = camera.camera.name;
        image.stamp_stddev = 0.0001;
        image.clock_epoch = camera.time_offset_epoch;
        image.width = 1024;
        image.height = 768;
        image.max_blobs = 4;
        if ((i < rooms.first.cameras.size()) == (point.position.x() < 0.0) &&
            camera.camera.sees(point.position)) {
          const Eigen::Vector2d pixel = *camera.camera.project(point.position);
          image.blobs.emplace_back();
          image.blobs.back().x = std::round(pixel.x());
          image.blobs.back().y = std::round(pixel.y());
        }
        bag.write("/" + image.camera + "/ir_blobs", image.arrival, image);
      }
    }
  }
}

TEST(JoinRoomsProgram, JoinsRecordedRooms) {
  TwoRooms rooms(11, 0.0);
  rooms.carryOften(6);
  import::Folder folder;
  for (const std::string name :
       {"hall.yaml", "lab.yaml", "in.bag", "hall.bag", "lab.bag", "out.yaml"}) {
    folder.write(name, "");
    folder.write(name + ".bak", "");
  }
  const auto at = [&](const std::string& name) { return folder.path() + "/" + name; };
  recordImages(rooms, at("in.bag"));
  geometry::writeRigFile(rooms.first, at("hall.yaml"));
  geometry::writeRigFile(rooms.second, at("lab.yaml"));
  const std::string join = "rosrun wiimote_tracker_calibration join_rooms " + at("hall.yaml") +
                           " " + at("lab.yaml") + " " + at("out.yaml") + " ";
  auto result = runCommand(join + at("in.bag"));
  EXPECT_EQ(result.first, 1);
  EXPECT_SAYS(result.second, "no points that were computed with " + at("hall.yaml"));
  for (const std::string room : {"hall", "lab"}) {
    result =
        runCommand("rosrun wiimote_tracker_triangulation track_bag --smooth --results-only --rig " +
                   at(room + ".yaml") + " " + at("in.bag") + " " + at(room + ".bag"));
    ASSERT_EQ(result.first, 0) << result.second;
  }
  result = runCommand(join + at("hall.bag") + " " + at("lab.bag"));
  ASSERT_EQ(result.first, 0) << result.second;
  EXPECT_SAYS(result.second, "4 cameras joined to the 4 of the first rig by 6 passages");
  const geometry::Rig joined = geometry::readRigFile(at("out.yaml"));
  for (const geometry::RigCamera& truth : rooms.trueCameras()) {
    const geometry::RigCamera* camera = joined.find(truth.camera.name);
    ASSERT_TRUE(camera != nullptr) << truth.camera.name;
    EXPECT_LT((camera->camera.center() - truth.camera.center()).norm(), 0.15);
  }
}

}  // namespace
}  // namespace wiimote_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
