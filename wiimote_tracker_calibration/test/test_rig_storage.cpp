// What saving a rig must not replace without a word.
#include "../src/ros/rig_storage.h"

#include <wiimote_tracker_triangulation/geometry/rig_file.h>

#include "expect_says.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <exception>
#include <filesystem>
#include <string>
#include <vector>

namespace wiimote_tracker {
namespace {

class RigStorage : public testing::Test {
 protected:
  ~RigStorage() override { std::filesystem::remove_all(folder_); }
  const std::string folder_ = testing::TempDir() + "rig_storage_" + std::to_string(::getpid());
};

TEST_F(RigStorage, ALensDoesNotReplaceSamples) {
  geometry::Rig rig;
  rig.cameras.resize(1);
  rig.cameras[0].camera.name = "samples";
  const std::string folder = folder_ + "/names";
  const std::vector<std::string> warnings = saveRig(rig, folder + "/rig.yaml");
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_SAYS(warnings[0], "samples.yaml is for samples, so the lens of samples has none");
  EXPECT_TRUE(std::filesystem::exists(folder + "/rig.yaml"));
  EXPECT_FALSE(std::filesystem::exists(folder + "/samples.yaml"));
}

TEST_F(RigStorage, ALensDoesNotReplaceARigThatWasSavedBefore) {
  geometry::Rig rig;
  rig.cameras.resize(1);
  rig.cameras[0].camera.name = "rig";
  const std::string folder = folder_ + "/rigs";
  for (const char* name : {"/rig.yaml", "/other.yaml"}) {
    const std::vector<std::string> warnings = saveRig(rig, folder + name);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_SAYS(warnings[0], "rig.yaml is for rigs, so the lens of rig has none: rename");
  }
  EXPECT_EQ(geometry::readRigFile(folder + "/rig.yaml").id(), rig.id());
}

TEST_F(RigStorage, ARigDoesNotReplaceALens) {
  geometry::Rig rig;
  rig.cameras.resize(1);
  rig.cameras[0].camera.name = "camera_1";
  const std::string folder = folder_ + "/lenses";
  EXPECT_TRUE(saveRig(rig, folder + "/rig.yaml").empty());
  try {
    saveRig(rig, folder + "/camera_1.yaml");
    ADD_FAILURE();
  } catch (const std::exception& error) {
    EXPECT_SAYS(error.what(), "camera_1.yaml is for the lens of camera_1: save the rig by another");
  }
  EXPECT_TRUE(saveRig(rig, folder + "/rig.yaml").empty());
}

TEST_F(RigStorage, ZonesThatWereWrittenButNotLoadedAreNotLostWithoutAWord) {
  geometry::Rig rig;
  rig.cameras.resize(1);
  rig.cameras[0].camera.name = "camera_1";
  const std::string path = folder_ + "/zones/rig.yaml";
  rig.zones = {{"hall", Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()}};
  EXPECT_TRUE(saveRig(rig, path).empty());
  EXPECT_TRUE(saveRig(rig, path).empty());
  rig.zones[0].maximum.z() = 2.0;
  const std::vector<std::string> warnings = saveRig(rig, path);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_SAYS(warnings[0], "other zones (hall), which are in " + path + ".bak until the next save");
}

TEST_F(RigStorage, ARigOfOtherCamerasIsNotReplacedWithoutAWord) {
  geometry::Rig rig;
  rig.cameras.resize(2);
  rig.cameras[0].camera.name = "hall_1";
  rig.cameras[1].camera.name = "hall_2";
  const std::string path = folder_ + "/cameras/rig.yaml";
  EXPECT_TRUE(saveRig(rig, path).empty());
  rig.cameras[0].camera.identity = "00:1f:32:00:00:00";  // they were unknown
  rig.cameras[1].camera.identity = "00:1f:32:00:00:01";
  EXPECT_TRUE(saveRig(rig, path).empty());
  rig.cameras[0].camera.identity = "00:1f:32:00:00:03";  // replaced
  EXPECT_TRUE(saveRig(rig, path).empty());
  rig.cameras[0].camera.name = "attic_1";
  rig.cameras[1].camera.identity = "00:1f:32:00:00:02";
  const std::vector<std::string> warnings = saveRig(rig, path);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_SAYS(warnings[0], "the file had a rig of other cameras (hall_1, hall_2), which is in " +
                               path + ".bak until the next save");
}

TEST_F(RigStorage, TheNewestVersionsAreKept) {
  geometry::Rig rig;
  rig.cameras.resize(1);
  rig.cameras[0].camera.name = "camera_1";
  std::vector<std::string> paths;
  for (int i = 0; i < 5; ++i)
    paths.push_back(keepVersion(rig, 1.7e9 + i, folder_ + "/kept/rig.yaml", 3));
  EXPECT_SAYS(paths[0], folder_ + "/kept/versions/20231114_221320_" + rig.id() + ".yaml");
  const std::string own = folder_ + "/kept/versions/0_before_the_show.yaml";
  geometry::writeRigFile(rig, own);
  paths.push_back(keepVersion(rig, 1.7e9 + 5, folder_ + "/kept/rig.yaml", 3));
  for (std::size_t i = 0; i < paths.size(); ++i)
    EXPECT_EQ(std::filesystem::exists(paths[i]), i >= 3) << paths[i];
  EXPECT_TRUE(std::filesystem::exists(own));
}

TEST_F(RigStorage, OnlyRigsThatAreThereAreOffered) {
  geometry::Rig rig;
  rig.cameras.resize(1);
  rig.cameras[0].camera.name = "camera_1";
  const std::string folder = folder_ + "/offered", path = folder + "/rig.yaml";
  EXPECT_EQ(describeEarlierRigs(path),
            "no earlier one is kept beside " + path + ": calibrate again");
  keepVersion(rig, 1.7e9, path);
  EXPECT_EQ(describeEarlierRigs(path),
            "load the one that you want: one of " + folder + "/versions/");
  EXPECT_TRUE(saveRig(rig, path).empty());
  EXPECT_TRUE(saveRig(rig, path).empty());
  EXPECT_EQ(describeEarlierRigs(path),
            "load the one that you want: " + path + ".bak or one of " + folder + "/versions/");
}

}  // namespace
}  // namespace wiimote_tracker
