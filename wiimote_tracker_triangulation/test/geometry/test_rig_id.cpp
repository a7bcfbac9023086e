// The id depends on everything that moves a point and on nothing else; rotations survive round
// trips.
#include "geometry/random_rigs.h"
#include "geometry/rotation.h"
#include "refusal_of.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <set>

namespace wiimote_tracker::geometry {
namespace {

using test::Random;

constexpr double kNotSet = std::numeric_limits<double>::quiet_NaN();

Rig someRig() {
  Random random(31);
  return test::randomRig(random, 3);
}

using Change = std::function<void(Rig&)>;

TEST(RigId, HasSixteenHexadecimalDigits) {
  const std::string id = someRig().id();
  EXPECT_EQ(16u, id.size());
  EXPECT_EQ(std::string::npos, id.find_first_not_of("0123456789abcdef"));
}

TEST(RigId, IsTheSameOnEveryMachine) {
  // Simple numbers only, so that the rig is the same everywhere. A change of this value invalidates
  // the id in every recorded bag. It was computed by an independent FNV-1a in Python.
  Rig rig;
  RigCamera camera;
  camera.camera.name = "a";
  camera.camera.world_from_camera.translation() << 1.0, 2.0, 3.0;
  rig.cameras.push_back(camera);
  EXPECT_EQ("36e23a6acebe73ed", rig.id());
}

TEST(RigId, ChangesWithEverythingThatMovesAPoint) {
  const std::vector<Change> changes = {
      [](Rig& r) { r.world_frame = "map"; },
      [](Rig& r) { r.ray_model = RayModel::kImageCenter; },
      [](Rig& r) { r.virtual_hfov = 0.7; },
      [](Rig& r) { r.cameras.pop_back(); },
      [](Rig& r) { r.cameras[1].camera.name = "other"; },
      [](Rig& r) { r.cameras[1].camera.identity = "ff:ff:ff:ff:ff:ff"; },
      [](Rig& r) { r.cameras[1].camera.intrinsics.width += 1; },
      [](Rig& r) { r.cameras[1].camera.intrinsics.height += 1; },
      [](Rig& r) { r.cameras[1].camera.intrinsics.fx += 1e-12; },
      [](Rig& r) { r.cameras[1].camera.intrinsics.fy += 1e-12; },
      [](Rig& r) { r.cameras[1].camera.intrinsics.cx += 1e-12; },
      [](Rig& r) { r.cameras[1].camera.intrinsics.cy += 1e-12; },
      [](Rig& r) { r.cameras[1].camera.intrinsics.distortion[0] += 1e-15; },
      [](Rig& r) { r.cameras[1].camera.intrinsics.distortion[1] += 1e-15; },
      [](Rig& r) { r.cameras[1].camera.intrinsics.distortion[2] += 1e-15; },
      [](Rig& r) { r.cameras[1].camera.intrinsics.distortion[3] += 1e-15; },
      [](Rig& r) { r.cameras[1].camera.intrinsics.distortion[4] += 1e-15; },
      [](Rig& r) {
        r.cameras[1].camera.intrinsics.distortion_model = DistortionModel::kEquidistant;
      },
      [](Rig& r) { r.cameras[1].camera.world_from_camera.translation().x() += 1e-14; },
      [](Rig& r) { r.cameras[1].camera.world_from_camera.translation().y() += 1e-14; },
      [](Rig& r) { r.cameras[1].camera.world_from_camera.translation().z() += 1e-14; },
      [](Rig& r) {
        r.cameras[1].camera.world_from_camera.rotate(
            Eigen::AngleAxisd(1e-12, Eigen::Vector3d::UnitX()));
      },
      [](Rig& r) { r.cameras[1].time_offset = 0.001; },
      [](Rig& r) { r.cameras[1].time_offset_rule = TimeOffsetRule::kAlways; },
      [](Rig& r) { r.cameras[1].time_offset_epoch = 1; },
      [](Rig& r) {
        r.cameras[1].masks.push_back({{10.0, 20.0}, 5.0});
      },
      [](Rig& r) {
        r.cameras[1].masks.push_back({{11.0, 20.0}, 5.0});
      },
      [](Rig& r) {
        r.cameras[1].masks.push_back({{10.0, 21.0}, 5.0});
      },
      [](Rig& r) {
        r.cameras[1].masks.push_back({{10.0, 20.0}, 6.0});
      },
  };
  std::set<std::string> ids = {someRig().id()};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Rig rig = someRig();
    changes[i](rig);
    EXPECT_TRUE(ids.insert(rig.id()).second) << "change " << i;
  }
}

TEST(RigId, DoesNotChangeWithWhatMovesNoPoint) {
  const std::vector<Change> changes = {
      [](Rig& r) { r.solved_at = 5.0; },
      [](Rig& r) { r.method = "square"; },
      [](Rig& r) { r.verdict = "good"; },
      [](Rig& r) {
        r.remap = remap::Remap{r.id(), remap::Model::kAffine, {}, {}};
      },
      [](Rig& r) {
        r.square_sides = {2.5, 2.5};
      },
      [](Rig& r) {
        r.square_pose = SquarePose{{1.0, 0.0}, 0.3};
      },
      [](Rig& r) { r.led_height = 0.1; },
      [](Rig& r) { r.covariance = Eigen::MatrixXd::Identity(48, 48); },
      [](Rig& r) {
        r.zones.push_back({"hall", {0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}});
      },
      [](Rig& r) { r.cameras[0].residual_px = 0.3; },
      [](Rig& r) { r.cameras[0].gravity = Eigen::Vector3d(0.0, -9.8, 0.0); },
      [](Rig& r) { r.cameras[0].camera.intrinsics.distortion[1] = 0.0; },
      [](Rig& r) { r.cameras[0].time_offset = -kNotSet; },
  };
  Rig reference = someRig();
  reference.cameras[0].camera.intrinsics.distortion[1] = -0.0;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Rig rig = reference;
    changes[i](rig);
    EXPECT_EQ(reference.id(), rig.id()) << "change " << i;
  }
}

TEST(Rotation, QuaternionSurvivesEveryRoundTripBitForBit) {
  Random random(32);
  for (int i = 0; i < 100000; ++i) {
    const Eigen::Quaterniond any = Eigen::Quaterniond(random.gaussian(), random.gaussian(),
                                                      random.gaussian(), random.gaussian())
                                       .normalized();
    const Eigen::Quaterniond q = canonicalQuaternion(any.toRotationMatrix());
    const Eigen::Matrix3d R = matrixFromQuaternion(q);
    const Eigen::Quaterniond again = canonicalQuaternion(R);
    ASSERT_TRUE((q.coeffs().array() == again.coeffs().array()).all());
    EXPECT_LT((R - any.toRotationMatrix()).norm(), 1e-13);
    EXPECT_GE(q.w(), 0.0);
  }
}

TEST(Rotation, TerminatesForAnyMatrix) {
  const Eigen::Matrix3d nothing = Eigen::Matrix3d::Constant(kNotSet);
  EXPECT_FALSE(canonicalQuaternion(nothing).coeffs().allFinite());
  canonicalQuaternion(Eigen::Matrix3d::Zero());
  canonicalQuaternion(Eigen::Matrix3d::Constant(1e300));
  canonicalQuaternion(-Eigen::Matrix3d::Identity());
}

TEST(Rotation, KnownRotations) {
  EXPECT_TRUE(canonicalQuaternion(Eigen::Matrix3d::Identity())
                  .isApprox(Eigen::Quaterniond::Identity(), 0.0));
  for (int axis = 0; axis < 3; ++axis) {
    // Half turns: w is 0 and the largest diagonal entry decides.
    const Eigen::Matrix3d half =
        Eigen::AngleAxisd(M_PI, Eigen::Vector3d::Unit(axis)).toRotationMatrix();
    const Eigen::Quaterniond q = canonicalQuaternion(half);
    EXPECT_NEAR(1.0, std::abs(q.vec()[axis]), 1e-15);
    EXPECT_LT((matrixFromQuaternion(q) - half).norm(), 1e-15);
  }
}

TEST(Rig, CheckNamesTheCameraAndTheFault) {
  const auto message = [](const Change& change) -> std::string {
    Rig rig = someRig();
    change(rig);
    return refusalOf([&] { rig.check(); });
  };
  const auto names = [&](const Change& change, const std::string& words) {
    return message(change).find(words) != std::string::npos;
  };
  EXPECT_EQ("not refused", message([](Rig&) {}));
  EXPECT_TRUE(names([](Rig& r) { r.cameras.clear(); }, "no camera"));
  EXPECT_TRUE(names([](Rig& r) { r.cameras[2].camera.name = "camera_0"; }, "two cameras"));
  EXPECT_TRUE(names([](Rig& r) { r.cameras[2].camera.name = "/camera_0"; }, "two cameras"));
  EXPECT_TRUE(names(
      [](Rig& r) {
        r.cameras[0].camera.name = "a/b";
        r.cameras[2].camera.name = "a_b";
      },
      "'a/b' and 'a_b', share the frame a_b_optical_frame and the file a_b.yaml"));
  EXPECT_TRUE(names([](Rig& r) { r.cameras[2].camera.name = ""; }, "no name"));
  EXPECT_TRUE(names([](Rig& r) { r.cameras[2].camera.name = "a b"; }, "'a b'"));
  EXPECT_TRUE(names([](Rig& r) { r.cameras[2].camera.name = "1st"; }, "'1st'"));
  EXPECT_TRUE(names([](Rig& r) { r.cameras[1].camera.intrinsics.fx = kNotSet; }, "camera_1': fx"));
  EXPECT_TRUE(
      names([](Rig& r) { r.cameras[1].camera.world_from_camera.translation().x() = kNotSet; },
            "camera_1"));
  EXPECT_TRUE(names([](Rig& r) { r.cameras[1].camera.world_from_camera.linear() *= 1.1; },
                    "not a rotation"));
  EXPECT_TRUE(names([](Rig& r) { r.cameras[1].camera.world_from_camera.linear() *= -1.0; },
                    "not a rotation"));
  EXPECT_TRUE(names([](Rig& r) { r.cameras[1].masks.push_back({{0.0, 0.0}, 0.0}); }, "mask"));
  EXPECT_TRUE(names([](Rig& r) { r.covariance = Eigen::MatrixXd::Zero(3, 3); }, "covariance"));
  EXPECT_TRUE(names([](Rig& r) { r.square_sides = {0.0, 2.5}; }, "side"));
  EXPECT_TRUE(names(
      [](Rig& r) {
        r.zones.push_back({"hall", {1.0, 0.0, 0.0}, {0.0, 1.0, 1.0}});
      },
      "hall"));
  EXPECT_TRUE(names(
      [](Rig& r) {
        r.zones.assign(2, {"hall", {0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}});
      },
      "twice"));
  for (const std::string& name : {std::string(), std::string("a\nb"), std::string(101, 'a')}) {
    const auto rename = [&](Rig& r) {
      r.zones.push_back({"hall", {0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}});
      r.zones.push_back({name, {0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}});
    };
    EXPECT_TRUE(names(rename, "name of zone 2")) << name;
  }
}

TEST(Rig, VirtualModelLooksThroughTheImageCentre) {
  Rig rig = someRig();
  RigCamera& camera = rig.cameras[0];
  camera.camera.intrinsics.width = 1024;
  camera.camera.intrinsics.height = 768;
  camera.camera.intrinsics.fx = 1306.3;
  camera.camera.intrinsics.fy = 1302.3;
  EXPECT_EQ(camera.camera.intrinsics.cx, rig.rayCamera(camera).intrinsics.cx);
  rig.ray_model = RayModel::kImageCenter;
  const Intrinsics centred = rig.rayCamera(camera).intrinsics;
  EXPECT_EQ(512.0, centred.cx);
  EXPECT_EQ(384.0, centred.cy);
  EXPECT_EQ(1306.3, centred.fx);
  EXPECT_EQ(1302.3, centred.fy);
  for (const double k : centred.distortion)
    EXPECT_EQ(0.0, k);
  rig.virtual_hfov = 41.0 * M_PI / 180.0;  // the paper's; its focal length is 1369 px
  EXPECT_NEAR(1369.4, rig.rayCamera(camera).intrinsics.fx, 0.1);
  EXPECT_NEAR(1369.4, rig.rayCamera(camera).intrinsics.fy, 0.1);
}

TEST(Rig, OpticalFrameHasNoSlashes) {
  EXPECT_EQ("wiimote_1_optical_frame", opticalFrame("wiimote_1"));
  EXPECT_EQ("wiimote_1_optical_frame", opticalFrame("/wiimote_1"));
  EXPECT_EQ("room_wiimote_1_optical_frame", opticalFrame("/room/wiimote_1"));
}

}  // namespace
}  // namespace wiimote_tracker::geometry
