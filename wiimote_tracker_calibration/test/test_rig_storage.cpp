// What saving a rig must not replace without a word.
#include "../src/ros/file_paths.h"
#include "../src/ros/parameters.h"
#include "../src/ros/requests.h"
#include "../src/ros/rig_storage.h"

#include <wiimote_tracker_triangulation/geometry/rig_file.h>

#include "expect_says.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstddef>
#include <exception>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace wiimote_tracker {
namespace {

class RigStorage : public testing::Test {
 protected:
  ~RigStorage() override { std::filesystem::remove_all(folder_); }
  static geometry::Rig rigOf(const std::vector<std::string>& cameras) {
    geometry::Rig rig;
    rig.cameras.resize(cameras.size());
    for (std::size_t i = 0; i < cameras.size(); ++i)
      rig.cameras[i].camera.name = cameras[i];
    return rig;
  }
  static std::string refusalOf(const std::function<void()>& call) {
    try {
      call();
    } catch (const Refusal& error) {
      return error.what();
    }
    return "";
  }
  const std::string folder_ = testing::TempDir() + "rig_storage_" + std::to_string(::getpid());
  RigFiles files_;
};

TEST_F(RigStorage, ALensDoesNotReplaceSamples) {
  geometry::Rig rig;
  rig.cameras.resize(1);
  rig.cameras[0].camera.name = "samples";
  const std::string folder = folder_ + "/names";
  const std::vector<std::string> warnings = files_.save(rig, folder + "/rig.yaml");
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
    const std::vector<std::string> warnings = files_.save(rig, folder + name);
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
  EXPECT_TRUE(files_.save(rig, folder + "/rig.yaml").empty());
  try {
    files_.save(rig, folder + "/camera_1.yaml");
    ADD_FAILURE();
  } catch (const std::exception& error) {
    EXPECT_SAYS(error.what(), "camera_1.yaml is for the lens of camera_1: save the rig by another");
  }
  EXPECT_TRUE(files_.save(rig, folder + "/rig.yaml").empty());
}

TEST_F(RigStorage, ZonesThatWereWrittenButNotLoadedAreNotLostWithoutAWord) {
  geometry::Rig rig;
  rig.cameras.resize(1);
  rig.cameras[0].camera.name = "camera_1";
  const std::string path = folder_ + "/zones/rig.yaml";
  rig.zones = {{"hall", Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()}};
  EXPECT_TRUE(files_.save(rig, path).empty());
  EXPECT_TRUE(files_.save(rig, path).empty());
  rig.zones[0].maximum.z() = 2.0;
  const std::vector<std::string> warnings = files_.save(rig, path);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_SAYS(warnings[0], "other zones (hall), which are in " + path + ".bak until the next save");
}

TEST_F(RigStorage, ARigOfOtherCamerasIsNotReplacedWithoutAWord) {
  geometry::Rig rig = rigOf({"hall_1", "hall_2"});
  const std::string path = folder_ + "/cameras/rig.yaml";
  EXPECT_TRUE(files_.save(rig, path).empty());
  rig.cameras[0].camera.identity = "00:1f:32:00:00:00";  // they were unknown
  rig.cameras[1].camera.identity = "00:1f:32:00:00:01";
  EXPECT_TRUE(files_.save(rig, path).empty());
  rig.cameras[0].camera.identity = "00:1f:32:00:00:03";  // replaced
  EXPECT_TRUE(files_.save(rig, path).empty());
  rig.cameras[0].camera.name = "attic_1";
  rig.cameras[1].camera.identity = "00:1f:32:00:00:02";
  EXPECT_EQ(refusalOf([&] { files_.save(rig, path); }),
            path +
                " holds a rig of hall_1, hall_2, which are other cameras: save to another file, "
                "so that each rig has a rig_file of its own, or save again to replace it");
  EXPECT_EQ(geometry::readRigFile(path).cameras[0].camera.name, "hall_1");
  EXPECT_TRUE(files_.save(rig, path).empty());
  EXPECT_EQ(geometry::readRigFile(path).id(), rig.id());
  EXPECT_EQ(geometry::readRigFile(path + ".bak").cameras[0].camera.name, "hall_1");
}

TEST_F(RigStorage, WhatAnotherTrackerSavedIsReplacedOnlyWhenThatIsMeant) {
  const std::string path = folder_ + "/two/rig.yaml", other_path = folder_ + "/two/other.yaml";
  const geometry::Rig ours = rigOf({"a", "b"}), theirs = rigOf({"a", "c"});
  RigFiles other;
  EXPECT_TRUE(other.save(theirs, path).empty());
  const auto save = [&](const std::string& file) { return [&, file] { files_.save(ours, file); }; };
  const std::string refusal =
      path +
      " holds a rig of a, c that this node has neither loaded nor saved: load it, save to "
      "another file, or save again to replace it";
  EXPECT_EQ(refusalOf(save(path)), refusal);
  EXPECT_EQ(refusalOf(save(other_path)), "");
  EXPECT_EQ(refusalOf(save(path)), refusal) << "long after the first refusal";
  EXPECT_EQ(refusalOf(save(path)), "");
  EXPECT_EQ(geometry::readRigFile(path).id(), ours.id());

  // Now the other one does not know what is in the file; by any of its names.
  const std::string name = folder_ + "/two/../two/rig.yaml";
  EXPECT_SAYS(refusalOf([&] { other.save(theirs, name); }), "holds a rig of a, b that this node");
  EXPECT_EQ(other.read(path).id(), ours.id());
  EXPECT_TRUE(other.save(theirs, name).empty());
  EXPECT_EQ(refusalOf([&] { files_.save(ours, path); }), refusal);
}

TEST_F(RigStorage, WhatWasWrittenBetweenTwoSavesIsNotReplaced) {
  const std::string path = folder_ + "/between/rig.yaml";
  const geometry::Rig ours = rigOf({"a", "b"});
  geometry::writeRigFile(rigOf({"a", "c"}), path);
  EXPECT_SAYS(refusalOf([&] { files_.save(ours, path); }), "a rig of a, c");
  geometry::writeRigFile(rigOf({"a", "d"}), path);
  EXPECT_SAYS(refusalOf([&] { files_.save(ours, path); }), "a rig of a, d");
  std::filesystem::remove(path);
  EXPECT_TRUE(files_.save(ours, path).empty());
}

TEST_F(RigStorage, ADamagedFileThatTheStartHasReadIsReplaced) {
  const std::string path = folder_ + "/damaged/rig.yaml";
  EXPECT_TRUE(RigFiles().save(rigOf({"a", "b"}), path).empty());
  std::filesystem::resize_file(path, 100);
  EXPECT_SAYS(refusalOf([&] { RigFiles().save(rigOf({"a", "b"}), path); }), " holds something ");
  EXPECT_THROW(files_.read(path), Error);
  EXPECT_TRUE(files_.save(rigOf({"a", "b"}), path).empty());
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
  EXPECT_EQ(describeEarlierRigs(path), "load an earlier rig of " + folder + "/: one of versions/");
  EXPECT_TRUE(files_.save(rig, path).empty());
  EXPECT_TRUE(files_.save(rig, path).empty());
  EXPECT_EQ(describeEarlierRigs(path),
            "load an earlier rig of " + folder + "/: rig.yaml.bak or one of versions/");
}

TEST_F(RigStorage, TheRigFileIsKnownByAnyOfItsNames) {
  const std::string folder = folder_ + "/links";
  EXPECT_TRUE(files_.save(rigOf({"a"}), folder + "/rig.yaml").empty());
  const auto link = [&folder](const std::string& name, const std::string& to) {
    std::filesystem::create_symlink(to, folder + "/" + name);
    return folder + "/" + name;
  };
  Parameters parameters;
  parameters.rig_file = folder + "/rig.yaml";
  EXPECT_TRUE(isRigFile(parameters.rig_file, parameters));
  EXPECT_TRUE(isRigFile(link("other", "rig.yaml"), parameters));
  EXPECT_FALSE(isRigFile(folder + "/hall.yaml", parameters));
  // Neither can be looked up.
  parameters.rig_file = link("endless", "endless");
  EXPECT_TRUE(isRigFile(parameters.rig_file, parameters));
  EXPECT_FALSE(isRigFile(link("also_endless", "also_endless"), parameters));
}

}  // namespace
}  // namespace wiimote_tracker
