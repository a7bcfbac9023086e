#include "geometry/random_rigs.h"
#include "ros/coverage/coverage_display.h"
#include "ros/coverage/coverage_markers.h"
#include "ros/coverage/walked_cells.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <gtest/gtest.h>
#include <sensor_msgs/point_cloud2_iterator.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace wiimote_tracker {
namespace {

using Eigen::Vector3d;
using geometry::CoverageCell;

const std::vector<CoverageCell> kCells = {
    {Vector3d(0.5, 0.5, 0.5), 3, 0.004},
    {Vector3d(0.5, 0.5, 1.5), 2, 0.050},
    {Vector3d(0.5, 0.5, 2.5), 2, 0.012},
    {Vector3d(0.5, 0.5, 3.5), 1, std::numeric_limits<double>::quiet_NaN()}};

TEST(CoverageDisplay, SaysWhatIsSeen) {
  EXPECT_EQ(sentenceOf(kCells, "the volume"),
            "75 % of the volume is seen by two cameras or more; points are known to 12 mm there "
            "(median).");
  EXPECT_EQ(sentenceOf({kCells[3]}, "the room"), "0 % of the room is seen by two cameras or more.");
}

TEST(CoverageDisplay, ColoursCellsByAccuracy) {
  const sensor_msgs::PointCloud2 cloud = coverageCloud("hall", kCells);
  EXPECT_EQ(cloud.header.frame_id, "hall");
  ASSERT_EQ(cloud.width * cloud.height, kCells.size());
  // By the convention of rviz and PCL: 0xRRGGBB in the bits of a float.
  sensor_msgs::PointCloud2ConstIterator<std::uint32_t> color(cloud, "rgb");
  EXPECT_EQ(*color, 0x00cc33U);        // green
  EXPECT_EQ(*(color + 1), 0xffcc33U);  // yellow
  EXPECT_EQ(*(color + 3), 0xe63333U);  // red
}

TEST(CoverageDisplay, StatesTheNumbersOfEachCell) {
  const sensor_msgs::PointCloud2 cloud = coverageCloud("hall", kCells);
  sensor_msgs::PointCloud2ConstIterator<float> place(cloud, "x"), cameras(cloud, "cameras"),
      stddev(cloud, "stddev");
  for (const CoverageCell& cell : kCells) {
    EXPECT_EQ(Eigen::Map<const Eigen::Vector3f>(&*place), cell.center.cast<float>());
    EXPECT_EQ(*cameras, static_cast<float>(cell.cameras));
    EXPECT_EQ(std::isnan(*stddev), std::isnan(cell.stddev));
    if (!std::isnan(cell.stddev)) {
      EXPECT_EQ(*stddev, static_cast<float>(cell.stddev));
    }
    ++place, ++cameras, ++stddev;
  }
}

TEST(CoverageDisplay, ExplainsTheColours) {
  const auto array = coverageMarkers("hall", kCells, 1.0, "so much; so well.");
  ASSERT_EQ(array.markers.size(), 1U);
  EXPECT_GT(array.markers[0].pose.position.z, 3.5);
  EXPECT_EQ(array.markers[0].text,
            "so much;\nso well.\nRed: seen by fewer than two.\nGreen to yellow: 5 to 50 mm.");
}

TEST(CoverageDisplay, BreaksLongSentencesBetweenWords) {
  const auto array = coverageMarkers(
      "hall", kCells, 1.0,
      "wiimote_3, turned by 15 degrees to the left and 10 degrees up, would make it 94 %.");
  EXPECT_EQ(array.markers[0].text,
            "wiimote_3, turned by 15 degrees to the left and 10\ndegrees up, would make it 94 %.\n"
            "Red: seen by fewer than two.\nGreen to yellow: 5 to 50 mm.");
}

TEST(CoverageDisplay, DrawsTheTwelveEdgesOfTheVolume) {
  const Eigen::AlignedBox3d volume(Vector3d(-1.0, 0.0, 0.5), Vector3d(1.0, 3.0, 4.5));
  const visualization_msgs::Marker edges = volumeMarkers("hall", volume).markers.at(0);
  EXPECT_EQ(edges.header.frame_id, "hall");
  EXPECT_TRUE(edges.lifetime.isZero());
  ASSERT_EQ(edges.points.size(), 24U);
  Eigen::AlignedBox3d drawn;
  Vector3d lengths = Vector3d::Zero();
  for (std::size_t i = 0; i < 24; i += 2) {
    drawn.extend(vectorOf(edges.points[i]));
    lengths += (vectorOf(edges.points[i + 1]) - vectorOf(edges.points[i])).cwiseAbs();
  }
  drawn.extend(vectorOf(edges.points.back()));
  EXPECT_TRUE(drawn.isApprox(volume));
  EXPECT_TRUE(lengths.isApprox(4.0 * volume.sizes())) << lengths;
}

TEST(CoverageDisplay, ColoursAWalkByTheCamerasThatSawIt) {
  auto cells = kCells;
  cells[2].cameras = 0;  // not walked through
  const auto array = walkMarkers("hall", cells, 1.0, "so far.");
  const visualization_msgs::Marker& cubes = array.markers[0];
  ASSERT_EQ(cubes.points.size(), 3U);
  EXPECT_EQ(cubes.colors[0].r, 0.0f);  // green
  EXPECT_EQ(cubes.colors[1].r, 1.0f);  // yellow
  EXPECT_LT(cubes.colors[2].g, 0.3f);  // red
  EXPECT_EQ(array.markers[1].text, "so far.\nRed: one camera, yellow: two, green: more.");
}

TEST(CoverageDisplay, AWalkThatHasNotBegunShowsNoCubes) {
  const auto array = walkMarkers("hall", {{Vector3d::Zero(), 0, 0.01}}, 1.0, "so far");
  EXPECT_EQ(array.markers[0].action, visualization_msgs::Marker::DELETE);
}

class CoverageWalk : public testing::Test {
 protected:
  void setRig(const std::string& id, double from) {
    const geometry::CellGrid grid(
        Eigen::AlignedBox3d(Vector3d::Constant(from), Vector3d::Constant(from + 2.0)), 1.0);
    std::vector<CoverageCell> cells;
    for (std::size_t i = 0; i < grid.count(); ++i)
      cells.push_back({grid.center(i), 4, 0.01});
    walked_.setRig(id, grid, cells);
  }
  bool see(const std::string& rig_id,
           std::uint8_t state = wiimote_tracker_msgs::TrackedPoint::TRACKED) {
    wiimote_tracker_msgs::TrackedPointArray points;
    points.rig_id = rig_id;
    points.points.resize(1);
    points.points[0].state = state;
    points.points[0].rays_used = 2;
    points.points[0].position = pointOf(Vector3d(0.5, 0.5, 0.5));
    return walked_.add(points);
  }
  WalkedCells walked_;
};

TEST_F(CoverageWalk, PointsWithoutARigAreIgnored) {
  EXPECT_FALSE(see(""));
  EXPECT_TRUE(walked_.cells().empty());
}

TEST_F(CoverageWalk, WhatMayBeNoLedIsIgnored) {
  using wiimote_tracker_msgs::TrackedPoint;
  setRig("a", 0.0);
  EXPECT_FALSE(see("a", TrackedPoint::TENTATIVE));
  EXPECT_FALSE(see("a", TrackedPoint::LOST));
  EXPECT_TRUE(see("a", TrackedPoint::PREDICTED));
}

TEST_F(CoverageWalk, ACorrectionOfTheRigKeepsIt) {
  setRig("a", 0.0);
  EXPECT_FALSE(see("b"));
  EXPECT_TRUE(see("a"));
  EXPECT_EQ(walked_.cells()[0].cameras, 2U);
  setRig("b", 0.001);
  EXPECT_EQ(walked_.cells()[0].cameras, 2U);
  EXPECT_EQ(walked_.cells()[1].cameras, 0U);
  EXPECT_FALSE(see("b")) << "nothing new";
  setRig("c", 0.1);
  EXPECT_EQ(walked_.cells()[0].cameras, 0U);
}

TEST(CoverageDisplay, SaysWhichWayToTurnACamera) {
  constexpr double kDegree = M_PI / 180.0;
  EXPECT_EQ(
      sentenceOf(geometry::CameraTurn{"b", -15.0 * kDegree, 10.0 * kDegree, 0.94}),
      " b, turned by 15 degrees to the left and 10 degrees up, would make it 94 %; then calibrate "
      "again.");
  EXPECT_EQ(sentenceOf(geometry::CameraTurn{"b", 0.0, -5.0 * kDegree, 0.5}),
            " b, turned by 5 degrees down, would make it 50 %; then calibrate again.");
}

TEST(CoverageDisplay, AdvisesToTurnACameraOnlyForAVolumeThatAPersonGave) {
  geometry::Rig rig;
  for (const Vector3d& target : {Vector3d(0.0, 0.0, 0.0), Vector3d(4.0, 0.0, 0.0)}) {
    rig.cameras.emplace_back();
    rig.cameras.back().camera.world_from_camera =
        geometry::lookAt({target.x(), -6.0, 3.0}, target, Vector3d::UnitZ());
  }
  CoverageParameters parameters;
  const Eigen::AlignedBox3d volume(Vector3d::Constant(-1.0), Vector3d::Constant(1.0));
  const geometry::CellGrid grid(volume, 0.5);
  EXPECT_EQ(adviceFor(rig, grid, parameters), "");
  parameters.volume = volume;
  EXPECT_NE(adviceFor(rig, grid, parameters).find("would make it 100 %"), std::string::npos);
}

TEST(CoverageDisplay, TheVolumeIsBetweenTheFloorAndTheCameras) {
  geometry::test::Random random(3);
  geometry::Rig rig = geometry::test::randomRig(random, 3);
  for (geometry::RigCamera& camera : rig.cameras)
    camera.camera.world_from_camera.translation().z() = -2.0;  // of a world with z down
  const Eigen::AlignedBox3d box = volumeOf(rig);
  EXPECT_EQ(box.min().z(), -2.0);
  EXPECT_EQ(box.max().z(), 0.0);
  for (const geometry::RigCamera& camera : rig.cameras)
    EXPECT_EQ(box.squaredExteriorDistance(camera.camera.center()), 0.0);
}

}  // namespace
}  // namespace wiimote_tracker
