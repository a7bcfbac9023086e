#pragma once

#include "geometry/random_rigs.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <cmath>

namespace wiimote_tracker::geometry::test {

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

/// A correction of the volume, and a wide-angle lens on the second camera.
inline Rig correctedRig(int cameras = 2) {
  Random random(44);
  Rig rig = fullRig(cameras);
  rig.cameras[1].camera.intrinsics = randomFisheye(random);
  rig.covariance.row(30).setZero();
  rig.covariance.col(30).setZero();
  remap::Remap remap;
  remap.rig_id = rig.id();
  remap.model = remap::Model::kThinPlate;
  for (int i = 0; i < 6; ++i)
    remap.support.push_back(random.inBox(1.0));
  for (int i = 0; i < 30; ++i)
    remap.parameters.push_back(random.gaussian() * 1e-3);
  rig.remap = remap;
  return rig;
}

}  // namespace wiimote_tracker::geometry::test
