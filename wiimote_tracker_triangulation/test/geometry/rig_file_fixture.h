#ifndef WIIMOTE_TRACKER_TRIANGULATION_TEST_GEOMETRY_RIG_FILE_FIXTURE_H
#define WIIMOTE_TRACKER_TRIANGULATION_TEST_GEOMETRY_RIG_FILE_FIXTURE_H

#include "geometry/random_rigs.h"
#include "refusal_of.h"
#include "wiimote_tracker_triangulation/geometry/rig_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace wiimote_tracker::geometry::test {

class RigFile : public testing::Test {
 protected:
  RigFile() {
    std::string pattern = (std::filesystem::temp_directory_path() / "rig_file_XXXXXX").string();
    folder_ = mkdtemp(&pattern[0]);
    path_ = (folder_ / "rig.yaml").string();
  }
  ~RigFile() override { std::filesystem::remove_all(folder_); }

  static std::string contentOf(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }

  void put(const std::string& content) { std::ofstream(path_, std::ios::binary) << content; }

  /// The error of readRigFile.
  static std::string complaint(const std::string& path) {
    return refusalOf([&] { readRigFile(path); });
  }

  std::string complaintAbout(const std::string& content) {
    put(content);
    return complaint(path_);
  }

  /// The file's content with one text replaced by another.
  std::string with(const std::string& from, const std::string& to) const {
    std::string content = written_;
    const std::size_t place = content.find(from);
    if (place == std::string::npos)
      throw std::logic_error("the test looks for '" + from + "', which is not in the file");
    return content.replace(place, from.size(), to);
  }

  void write(const Rig& rig) {
    writeRigFile(rig, path_);
    written_ = contentOf(path_);
  }

  std::filesystem::path folder_;
  std::string path_;
  std::string written_;
};

/// Every field filled, with numbers that have no short decimal form.
inline Rig fullRig(int cameras = 2) {
  Random random(41);
  Rig rig = randomRig(random, cameras);
  rig.world_frame = "world";
  rig.solved_at = 1766188800.123456789;
  rig.method = "square: \"four corners\"\nsecond line # no comment";
  rig.ray_model = RayModel::kImageCenter;
  rig.virtual_hfov = 41.0 * M_PI / 180.0;
  rig.square_sides = {2.5, 1.0 / 3.0};
  rig.square_pose = SquarePose{{1.0 / 7.0, -0.5}, 0.3};
  rig.led_height = 0.1;
  rig.verdict = "gut genug für alle: 0.3 px";
  rig.zones = {{"hall", {0.1, 0.2, 0.3}, {1.0 / 7.0, 2.0, 3.0}}};
  rig.covariance = Eigen::MatrixXd(16 * cameras, 16 * cameras);
  for (Eigen::Index i = 0; i < rig.covariance.size(); ++i)
    rig.covariance(i) = i % 5 ? 0.0 : random.gaussian() * 1e-9;
  RigCamera& first = rig.cameras[0];
  first.time_offset = -1.0 / 300.0;
  first.time_offset_rule = TimeOffsetRule::kOneEpoch;
  first.time_offset_epoch = 4294967295u;
  first.gravity = Eigen::Vector3d(0.1, -9.8, 1.0 / 3.0);
  first.masks = {{{1.0 / 3.0, 700.0}, 12.5}, {{3.0, 4.0}, 5.0}};
  first.residual_px = 0.1 + 0.2;
  first.residual_m = 1e-3 / 3.0;
  first.observations = 120;
  first.inliers = 119;
  return rig;
}

}  // namespace wiimote_tracker::geometry::test

#endif  // WIIMOTE_TRACKER_TRIANGULATION_TEST_GEOMETRY_RIG_FILE_FIXTURE_H
