// rig.yaml: round trips are exact, and a failed write loses nothing.
#include "geometry/rotation.h"
#include "rig_file_fixture.h"
#include "wiimote_tracker_triangulation/geometry/error.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

namespace wiimote_tracker::geometry::test {
namespace {

namespace fs = std::filesystem;

constexpr double kUnset = std::numeric_limits<double>::quiet_NaN();

/// 0 is not -0.
bool same(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) || (a == b && std::signbit(a) == std::signbit(b));
}

void expectSame(const RigCamera& a, const RigCamera& b) {
  EXPECT_EQ(a.camera.name, b.camera.name);
  EXPECT_EQ(a.camera.identity, b.camera.identity);
  const Intrinsics& i = a.camera.intrinsics;
  const Intrinsics& k = b.camera.intrinsics;
  EXPECT_EQ(i.width, k.width);
  EXPECT_EQ(i.height, k.height);
  EXPECT_TRUE(same(i.fx, k.fx) && same(i.fy, k.fy) && same(i.cx, k.cx) && same(i.cy, k.cy));
  for (int d = 0; d < 5; ++d)
    EXPECT_TRUE(same(i.distortion[d], k.distortion[d]));
  for (int n = 0; n < 3; ++n)
    EXPECT_TRUE(same(a.camera.center()[n], b.camera.center()[n]));
  const Eigen::Quaterniond q = canonicalQuaternion(a.camera.world_from_camera.linear());
  const Eigen::Quaterniond r = canonicalQuaternion(b.camera.world_from_camera.linear());
  for (int n = 0; n < 4; ++n)
    EXPECT_TRUE(same(q.coeffs()[n], r.coeffs()[n]));
  EXPECT_TRUE(same(a.time_offset, b.time_offset));
  EXPECT_EQ(a.time_offset_rule, b.time_offset_rule);
  EXPECT_EQ(a.time_offset_epoch, b.time_offset_epoch);
  EXPECT_EQ(a.gravity, b.gravity);
  ASSERT_EQ(a.masks.size(), b.masks.size());
  for (std::size_t m = 0; m < a.masks.size(); ++m) {
    EXPECT_EQ(a.masks[m].center, b.masks[m].center);
    EXPECT_TRUE(same(a.masks[m].radius, b.masks[m].radius));
  }
  EXPECT_TRUE(same(a.residual_px, b.residual_px) && same(a.residual_m, b.residual_m));
  EXPECT_EQ(a.observations, b.observations);
  EXPECT_EQ(a.inliers, b.inliers);
}

void expectSame(const Rig& a, const Rig& b) {
  EXPECT_EQ(a.world_frame, b.world_frame);
  EXPECT_TRUE(same(a.solved_at, b.solved_at));
  EXPECT_EQ(a.method, b.method);
  EXPECT_EQ(a.ray_model, b.ray_model);
  EXPECT_TRUE(same(a.virtual_hfov, b.virtual_hfov) && same(a.led_height, b.led_height));
  EXPECT_EQ(a.square_sides, b.square_sides);
  ASSERT_EQ(a.square_pose.has_value(), b.square_pose.has_value());
  if (a.square_pose) {
    EXPECT_EQ(a.square_pose->origin, b.square_pose->origin);
    EXPECT_EQ(a.square_pose->yaw, b.square_pose->yaw);
  }
  EXPECT_EQ(a.verdict, b.verdict);
  EXPECT_EQ(a.covariance, b.covariance);
  ASSERT_EQ(a.zones.size(), b.zones.size());
  for (std::size_t z = 0; z < a.zones.size(); ++z) {
    EXPECT_EQ(a.zones[z].name, b.zones[z].name);
    EXPECT_EQ(a.zones[z].minimum, b.zones[z].minimum);
    EXPECT_EQ(a.zones[z].maximum, b.zones[z].maximum);
  }
  ASSERT_EQ(a.cameras.size(), b.cameras.size());
  for (std::size_t c = 0; c < a.cameras.size(); ++c)
    expectSame(a.cameras[c], b.cameras[c]);
  EXPECT_EQ(a.id(), b.id());
}

TEST_F(RigFile, ComesBackBitForBit) {
  const Rig rig = fullRig();
  write(rig);
  const Rig read = readRigFile(path_);
  expectSame(rig, read);
  writeRigFile(read, path_);
  EXPECT_EQ(written_, contentOf(path_));
}

TEST_F(RigFile, ACorrectionOfTheVolumeAndAWideLensComeBackBitForBit) {
  const Rig rig = correctedRig();
  write(rig);
  const Rig read = readRigFile(path_);
  expectSame(rig, read);
  EXPECT_EQ(DistortionModel::kEquidistant, read.cameras[1].camera.intrinsics.distortion_model);
  ASSERT_TRUE(read.remap);
  EXPECT_EQ(rig.remap->rig_id, read.remap->rig_id);
  EXPECT_EQ(rig.remap->model, read.remap->model);
  EXPECT_EQ(rig.remap->parameters, read.remap->parameters);
  EXPECT_EQ(rig.remap->support, read.remap->support);
  writeRigFile(read, path_);
  EXPECT_EQ(written_, contentOf(path_));
}

TEST_F(RigFile, AFileWithoutACorrectionHasNone) {
  write(fullRig());
  EXPECT_EQ(std::string::npos, written_.find("remap"));
  EXPECT_FALSE(readRigFile(path_).remap);
}

TEST_F(RigFile, FaultsOfACorrectionAndAWideLensAreNamedByKey) {
  write(correctedRig());
  const auto names = [&](const std::string& from, const std::string& to, const std::string& key) {
    const std::string complaint = complaintAbout(with(from, to));
    EXPECT_NE(std::string::npos, complaint.find(path_)) << complaint;
    EXPECT_NE(std::string::npos, complaint.find(key)) << complaint;
  };
  names("model: thin_plate", "model: rubber", "remap/model");
  names("model: thin_plate", "model: affine", "parameters, but affine needs 12");
  names("parameters: [", "parameters: [1.0, ", "31 parameters");
  names("parameters: [", "parameters: [x, ", "remap/parameters");
  names("support:\n    - [", "support:\n    - [1.0, ", "remap/support");
  names("support:", "supports:", "remap/support");
  names("rig_id: \"", "rig_id: \"\"  # ", "has no rig id");
  names("distortion_model: equidistant", "distortion_model: plumb_bob",
        "camera_1/distortion_coefficients");
  names("distortion_model: equidistant", "distortion_model: fisheye",
        "must be plumb_bob (k1, k2, p1, p2, k3) or equidistant (k1, k2, k3, k4)");
}

TEST_F(RigFile, TheUnusedCoefficientOfAWideLensHasNoVariance) {
  Rig rig = correctedRig();
  rig.covariance(30, 30) = 1e-9;
  EXPECT_THROW(writeRigFile(rig, path_), InvalidRigError);
}

TEST_F(RigFile, AFileWithoutZonesShowsHowOneIsWritten) {
  Rig rig = fullRig();
  rig.zones.clear();
  write(rig);
  EXPECT_TRUE(readRigFile(path_).zones.empty());
  put(with("zones: []  # [m] such as [", "zones: ["));
  const std::vector<Zone> zones = readRigFile(path_).zones;
  ASSERT_EQ(1u, zones.size());
  EXPECT_EQ("hall", zones[0].name);
  EXPECT_EQ(Eigen::Vector3d(2.0, 3.0, 2.5), zones[0].maximum);
}

TEST_F(RigFile, ManyRandomRigsComeBackBitForBit) {
  Random random(42);
  for (int i = 0; i < 20; ++i) {
    const Rig rig = randomRig(random, 4);
    write(rig);
    expectSame(rig, readRigFile(path_));
  }
}

TEST_F(RigFile, NumbersAreFloatingPointForRosparamToo) {
  // static_transform_publisher refuses integers, and rosparam reads 1e-09 as a string.
  Rig rig = fullRig(1);
  rig.cameras[0].camera.world_from_camera = Eigen::Isometry3d::Identity();
  rig.cameras[0].camera.world_from_camera.translation() << 4.0, -1e-9, 1e300;
  write(rig);
  for (const std::string line :
       {"x: 4.0\n", "y: -1.0e-09\n", "z: 1.0e+300\n", "x: 0.0\n", "w: 1.0\n"})
    EXPECT_NE(std::string::npos, written_.find(line)) << line;
  rig.cameras[0].camera.world_from_camera.translation() << 1e-20, -0.0, 1e22;
  write(rig);
  for (const std::string line : {"y: -0.0\n", "z: 1.0e+22\n"})
    EXPECT_NE(std::string::npos, written_.find(line)) << line;
  expectSame(rig, readRigFile(path_));
}

TEST_F(RigFile, KeepsTheOldFileAsABackup) {
  const Rig first = fullRig();
  Rig second = first;
  second.verdict = "second";
  write(first);
  EXPECT_FALSE(fs::exists(path_ + ".bak"));
  const std::string old = written_;
  write(second);
  EXPECT_EQ(old, contentOf(path_ + ".bak"));
  EXPECT_EQ("second", readRigFile(path_).verdict);
}

TEST_F(RigFile, HasItsBackupAtAllTimes) {
  const std::string kept = path_ + ".bak";
  write(fullRig());
  write(fullRig());
  std::ofstream(kept + ".part") << "left by a crash";
  std::atomic<bool> ends = false;
  int gaps = 0;
  std::thread reader([&] {
    while (!ends)
      gaps += fs::exists(kept) ? 0 : 1;
  });
  for (int i = 0; i < 200; ++i)
    write(fullRig());
  ends = true;
  reader.join();
  EXPECT_EQ(0, gaps);
  EXPECT_FALSE(fs::exists(kept + ".part"));
}

TEST_F(RigFile, DoesNotReplaceAFileOfAnotherKind) {
  for (const std::string other :
       {"# Captured.\nformat: wiimote_tracker_samples\nversion: 1\n", "#ROSBAG V2.0\n"}) {
    put(other);
    EXPECT_THROW(writeRigFile(fullRig(), path_), FileError);
    EXPECT_EQ(contentOf(path_), other);
  }
  put("a damaged file");
  writeRigFile(fullRig(), path_);
  EXPECT_EQ(complaint(path_), "not refused");
}

TEST_F(RigFile, MakesFoldersAndFollowsALink) {
  const std::string deep = (folder_ / "a" / "b" / "rig.yaml").string();
  writeRigFile(fullRig(), deep);
  fs::create_symlink(deep, path_);
  Rig second = fullRig();
  second.verdict = "second";
  writeRigFile(second, path_);
  EXPECT_TRUE(fs::is_symlink(path_));
  EXPECT_EQ("second", readRigFile(deep).verdict);
}

TEST_F(RigFile, AFailedWriteLeavesTheOldFile) {
  write(fullRig());
  Rig larger = fullRig(4);
  // Simulates a full disk: files must not grow beyond the old one's size.
  rlimit before{};
  ASSERT_EQ(0, getrlimit(RLIMIT_FSIZE, &before));
  rlimit tight = before;
  tight.rlim_cur = written_.size() + 10;
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(0, setrlimit(RLIMIT_FSIZE, &tight));
  std::string complaint;
  try {
    writeRigFile(larger, path_);
  } catch (const FileError& e) {
    complaint = e.what();
  }
  ASSERT_EQ(0, setrlimit(RLIMIT_FSIZE, &before));
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(std::string::npos, complaint.find(path_)) << complaint;
  EXPECT_EQ(written_, contentOf(path_));
  for (const auto& entry : fs::directory_iterator(folder_)) {
    EXPECT_EQ(std::string::npos, entry.path().string().find(".part"))
        << "left behind: " << entry.path();
  }
}

TEST_F(RigFile, CannotBeWrittenWhereThereIsNoFolder) {
  put("in the way");
  EXPECT_THROW(writeRigFile(fullRig(), path_ + "/rig.yaml"), FileError);
  EXPECT_THROW(writeRigFile(fullRig(), folder_.string()), FileError);
  EXPECT_EQ("in the way", contentOf(path_));
}

TEST_F(RigFile, AnUnusableRigIsNotWritten) {
  write(fullRig());
  Rig bad = fullRig();
  bad.cameras[1].camera.intrinsics.fx = kUnset;
  EXPECT_THROW(writeRigFile(bad, path_), InvalidRigError);
  bad = fullRig();
  bad.cameras[1].camera.name = bad.cameras[0].camera.name;
  EXPECT_THROW(writeRigFile(bad, path_), InvalidRigError);
  EXPECT_EQ(written_, contentOf(path_));
}

TEST_F(RigFile, ThreadsMayWriteAtTheSameTime) {
  write(fullRig());
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&] {
      for (int n = 0; n < 10; ++n)
        EXPECT_NO_THROW(writeRigFile(fullRig(), path_));
    });
  for (std::thread& thread : threads)
    thread.join();
  EXPECT_EQ(contentOf(path_), written_);
  EXPECT_EQ(contentOf(path_ + ".bak"), written_);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 2);
}

}  // namespace
}  // namespace wiimote_tracker::geometry::test
