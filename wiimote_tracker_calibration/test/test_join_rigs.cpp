// Two rigs in one world, drawn round a known truth from known covariances.

#include "rooms/join_rigs.h"

#include "expect_says.h"
#include "refusal_of.h"
#include "samples/grade.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/triangulate.h>

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace wiimote_tracker::rooms {
namespace {

/// Six cameras in a row of two rooms, in the first world.
std::vector<geometry::Camera> trueCameras() {
  std::vector<geometry::Camera> cameras;
  for (int i = 0; i < 6; ++i) {
    geometry::Camera camera;
    camera.name = "camera_" + std::to_string(i + 1);
    const Eigen::Vector3d position(2.0 * i, i % 2 == 0 ? -4.0 : 6.0, 2.0 + 0.1 * i);
    camera.world_from_camera =
        geometry::lookAt(position, Eigen::Vector3d(5.0, 1.0, 1.0), Eigen::Vector3d::UnitZ());
    cameras.push_back(camera);
  }
  return cameras;
}

Eigen::Isometry3d worldFromSecond() {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() =
      Eigen::AngleAxisd(2.0, Eigen::Vector3d(0.1, -0.2, 1.0).normalized()).toRotationMatrix();
  motion.translation() = Eigen::Vector3d(7.0, 1.0, -0.3);
  return motion;
}

/// Correlated errors of the poses of millimetres and milliradians, of the lenses of pixels.
Eigen::MatrixXd correlatedErrors(std::size_t cameras, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const auto size = static_cast<Eigen::Index>(10 * cameras);
  const Eigen::MatrixXd mixed = Eigen::MatrixXd::NullaryExpr(
      size, size, [&] { return 1.0 / std::sqrt(static_cast<double>(size)) * normal(random); });
  Eigen::MatrixXd by_causes = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(16 * cameras), size);
  for (Eigen::Index i = 0; i < size / 10; ++i) {
    by_causes.middleRows<6>(16 * i) = 0.003 * mixed.middleRows<6>(10 * i);
    by_causes.middleRows<4>(16 * i + 6) = 3.0 * mixed.middleRows<4>(10 * i + 6);
  }
  return by_causes * by_causes.transpose();
}

Eigen::Matrix3d turn(const Eigen::Vector3d& vector) {
  return Eigen::AngleAxisd(vector.norm(), vector.normalized()).toRotationMatrix();
}

/// Cameras `begin` to before `end`, in the world `world`.
geometry::Rig exactRig(int begin,
                       int end,
                       const Eigen::Isometry3d& world,
                       std::mt19937_64& random) {
  geometry::Rig rig;
  for (int i = begin; i < end; ++i) {
    geometry::RigCamera camera;
    camera.camera = trueCameras()[static_cast<std::size_t>(i)];
    camera.camera.world_from_camera = world.inverse() * camera.camera.world_from_camera;
    rig.cameras.push_back(camera);
  }
  rig.covariance = correlatedErrors(rig.cameras.size(), random);
  return rig;
}

/// The same as somebody calibrates it: with errors of its covariance.
geometry::Rig drawn(geometry::Rig rig, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const Eigen::Index size = rig.covariance.rows();
  const Eigen::MatrixXd regular = rig.covariance + 1e-18 * Eigen::MatrixXd::Identity(size, size);
  const Eigen::MatrixXd root = regular.llt().matrixL();
  const Eigen::VectorXd errors =
      root * Eigen::VectorXd::NullaryExpr(size, [&] { return normal(random); });
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    Eigen::Isometry3d& pose = rig.cameras[i].camera.world_from_camera;
    const Eigen::VectorXd error = errors.segment(16 * static_cast<Eigen::Index>(i), 6);
    pose.linear() = turn(-error.head<3>()) * pose.linear();
    pose.translation() -= error.tail<3>();
    geometry::Intrinsics& lens = rig.cameras[i].camera.intrinsics;
    const Eigen::VectorXd of_lens = errors.segment(16 * static_cast<Eigen::Index>(i) + 6, 4);
    lens.fx -= of_lens[0];
    lens.fy -= of_lens[1];
    lens.cx -= of_lens[2];
    lens.cy -= of_lens[3];
  }
  return rig;
}

/// Squared normalised error of all poses; on average their number of parameters.
double normalizedSquare(const geometry::Rig& rig, int begin) {
  const auto cameras = static_cast<Eigen::Index>(rig.cameras.size());
  Eigen::VectorXd errors(6 * cameras);
  Eigen::MatrixXd covariance(6 * cameras, 6 * cameras);
  for (Eigen::Index i = 0; i < cameras; ++i) {
    const Eigen::Isometry3d& pose =
        rig.cameras[static_cast<std::size_t>(i)].camera.world_from_camera;
    const Eigen::Isometry3d truth =
        trueCameras()[static_cast<std::size_t>(begin + i)].world_from_camera;
    const Eigen::AngleAxisd off(truth.linear() * pose.linear().transpose());
    errors.segment<3>(6 * i) = off.angle() * off.axis();
    errors.segment<3>(6 * i + 3) = truth.translation() - pose.translation();
    for (Eigen::Index j = 0; j < cameras; ++j)
      covariance.block<6, 6>(6 * i, 6 * j) = rig.covariance.block<6, 6>(16 * i, 16 * j);
  }
  return geometry::squaredMahalanobis(errors, covariance);
}

/// Means over the runs that were not refused.
struct Trials {
  double square = 0.0;        ///< normalizedSquare()
  double disagreement = 0.0;  ///< Chi-squared of what the rigs share.
  int refused = 0;            ///< By chance one run in a thousand.
};

Trials trialsOf(int runs, const std::function<JoinedRigs()>& join) {
  Trials trials;
  int joined = 0;
  for (int run = 0; run < runs; ++run) {
    try {
      const JoinedRigs result = join();
      ++joined;
      trials.square += normalizedSquare(result.rig, 0);
      trials.disagreement += result.motion.chi_squared;
    } catch (const Error&) {
      ++trials.refused;
    }
  }
  trials.square /= joined;
  trials.disagreement /= joined;
  return trials;
}

class JoinRigs : public ::testing::Test {
 protected:
  std::mt19937_64 random_{1};
  geometry::Rig first_ = exactRig(0, 4, Eigen::Isometry3d::Identity(), random_);
  geometry::Rig second_ = exactRig(2, 6, worldFromSecond(), random_);
};

TEST_F(JoinRigs, ARigIsNotJoinedWithItself) {
  EXPECT_SAYS(refusalOf([&] { joinRigs(first_, first_); }), "the same rig");
  geometry::Rig again = exactRig(0, 3, worldFromSecond(), random_);
  EXPECT_SAYS(refusalOf([&] { joinRigs(first_, again); }), "nothing to join");
  // The other way round there is one to add.
  EXPECT_EQ(joinRigs(again, first_).rig.cameras.size(), 4U);
}

TEST_F(JoinRigs, ExactRigsMakeAnExactOne) {
  const JoinedRigs joined = joinRigs(first_, second_);
  EXPECT_LT((joined.motion.first_from_second.matrix() - worldFromSecond().matrix()).norm(), 1e-9);
  EXPECT_EQ(joined.motion.degrees_of_freedom, 14);
  EXPECT_SAYS(joined.message,
              "2 cameras joined to the 4 of the first rig over camera_3 and camera_4;");
  ASSERT_EQ(joined.rig.cameras.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    const geometry::Camera truth = trueCameras()[i];
    const geometry::Camera& camera = joined.rig.cameras[i].camera;
    EXPECT_EQ(camera.name, truth.name);
    EXPECT_LT((camera.world_from_camera.matrix() - truth.world_from_camera.matrix()).norm(), 1e-9);
  }
  EXPECT_EQ(joined.rig.covariance.rows(), 96);
  // What the first room had stays.
  EXPECT_LT((joined.rig.covariance.topLeftCorner(64, 64) - first_.covariance).norm(), 1e-15);
}

TEST_F(JoinRigs, WhatIsLostIsNamed) {
  EXPECT_EQ(joinRigs(first_, second_).message.find("left out"), std::string::npos);
  first_.zones = {{"door", Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()}};
  const std::vector<Eigen::Vector3d> tetrahedron = {
      {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  first_.remap =
      remap::Remap{first_.id(), remap::Model::kAffine, std::vector<double>(12, 0.0), tetrahedron};
  second_.zones = {{"desk", Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()}};
  const JoinedRigs joined = joinRigs(first_, second_);
  EXPECT_SAYS(joined.message, "the zones of the second rig (desk) are left out");
  EXPECT_SAYS(joined.message, "corrections of the volume are left out");
  EXPECT_FALSE(joined.rig.remap);
  ASSERT_EQ(joined.rig.zones.size(), 1U);
  EXPECT_EQ(joined.rig.zones[0].name, "door");
}

TEST_F(JoinRigs, TheVerdictIsNoBetterThanThoseOfBoth) {
  first_.verdict = "good; points are known to 2 mm";
  second_.verdict = "good";
  const std::string usable = joinRigs(first_, second_).rig.verdict;
  EXPECT_EQ(samples::gradeOf(usable), samples::Grade::kUsable) << usable;
  EXPECT_SAYS(usable, "usable: ");
  EXPECT_SAYS(usable, "; first: good; points are known to 2 mm; second: good");
  second_.verdict = "redo corner 3: it was 50 mm off";
  const std::string redo = joinRigs(first_, second_).rig.verdict;
  EXPECT_EQ(samples::gradeOf(redo), samples::Grade::kRedo) << redo;
}

TEST_F(JoinRigs, ExtensiveRunsHaveErrorsAsLargeAsStated) {
  for (const int shared : {1, 2}) {
    const geometry::Rig second = exactRig(4 - shared, 6, worldFromSecond(), random_);
    const int kRuns = 200;
    const Trials trials =
        trialsOf(kRuns, [&] { return joinRigs(drawn(first_, random_), drawn(second, random_)); });
    EXPECT_LE(trials.refused, 2);
    // Means of chi-squared, to within four standard deviations.
    EXPECT_NEAR(trials.square, 36.0, 4.0 * std::sqrt(72.0 / kRuns));
    const double freedom = 10.0 * shared - 6.0;
    EXPECT_NEAR(trials.disagreement, freedom, 4.0 * std::sqrt(2.0 * freedom / kRuns));
  }
}

/// The same with lenses known to 10 px, whose principal points turn the cameras, as in each rig
/// that was calibrated by waving: the rest is known to 0.3 mm and 0.3 mrad.
geometry::Rig turnedByLenses(geometry::Rig rig) {
  rig.covariance.setZero();
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const Eigen::Index row = geometry::firstParameter(i);
    const geometry::Camera& camera = rig.cameras[i].camera;
    Eigen::Matrix<double, 16, 16> by_causes = Eigen::Matrix<double, 16, 16>::Zero();
    by_causes.topLeftCorner<6, 6>().diagonal().setConstant(3e-4);
    by_causes.block<4, 4>(6, 6).diagonal().setConstant(10.0);
    const Eigen::Matrix3d axes = camera.world_from_camera.linear();
    by_causes.block<3, 1>(0, 8) = -10.0 / camera.intrinsics.fx * axes.col(1);
    by_causes.block<3, 1>(0, 9) = 10.0 / camera.intrinsics.fy * axes.col(0);
    rig.covariance.block<16, 16>(row, row) = by_causes * by_causes.transpose();
  }
  return rig;
}

TEST_F(JoinRigs, ALensThatTurnsACameraInBothRigsDoesNotTurnTheSecondRoom) {
  const geometry::Rig first = turnedByLenses(first_);
  const geometry::Rig second = turnedByLenses(exactRig(3, 6, worldFromSecond(), random_));
  const int kRuns = 100;
  double sum = 0.0;
  double squares = 0.0;
  JoinedRigs joined;
  for (int run = 0; run < kRuns; ++run) {
    joined = joinRigs(drawn(first, random_), drawn(second, random_));
    sum += normalizedSquare(joined.rig, 0) / kRuns;
    const Eigen::Vector3d error = joined.rig.cameras[5].camera.world_from_camera.translation() -
                                  trueCameras()[5].world_from_camera.translation();
    squares += error.squaredNorm() / kRuns;
  }
  EXPECT_NEAR(sum, 36.0, 4.0 * std::sqrt(72.0 / kRuns));
  // By the pose of camera_4 alone: 10.8 m away, turned by 10 px in either rig.
  const double lever = (trueCameras()[5].center() - trueCameras()[3].center()).norm();
  EXPECT_LT(std::sqrt(squares), 0.2 * lever * 10.0 / 1306.3) << lever;
  EXPECT_SAYS(joined.message, "the second room is known to ");
  EXPECT_SAYS(joined.message, "a second shared camera would check");
}

TEST_F(JoinRigs, TheAccuracyOfTheSecondRoomIsSaid) {
  geometry::Rig second = exactRig(3, 6, worldFromSecond(), random_);
  EXPECT_EQ(joinRigs(first_, second).message.find("let another camera see both"),
            std::string::npos);
  EXPECT_SAYS(joinRigs(first_, second_).message,
              "(standard deviations, to which the errors within the second rig add: see its");
  second.covariance *= 100.0;
  EXPECT_SAYS(joinRigs(first_, second).message,
              "for 5 cm and 0.5 degrees let another camera see both rooms");
}

TEST_F(JoinRigs, AnotherLensIsRefused) {
  const geometry::Rig second = exactRig(3, 6, worldFromSecond(), random_);
  first_.cameras[3].camera.intrinsics.fx += 60.0;
  EXPECT_SAYS(refusalOf([&] { joinRigs(first_, second); }),
              "the lens of camera_4 in the second rig is not that in the first");
}

TEST_F(JoinRigs, ACameraThatWasMovedIsNamed) {
  second_.cameras[1].camera.world_from_camera.translation().x() += 0.2;
  EXPECT_SAYS(refusalOf([&] { joinRigs(first_, second_); }), "camera_3 and camera_4 do not stand");
  geometry::Rig second = exactRig(1, 6, worldFromSecond(), random_);
  second.cameras[1].camera.world_from_camera.translation().x() += 0.2;
  EXPECT_SAYS(refusalOf([&] { joinRigs(first_, second); }),
              "camera_3 does not stand to the other shared cameras");
  first_.cameras[3].gravity = Eigen::Vector3d(0.0, -9.8, 0.0);
  second_.cameras[1].gravity = Eigen::Vector3d(0.0, -9.7, 0.9);
  EXPECT_SAYS(refusalOf([&] { joinRigs(first_, second_); }), "camera_4 was turned by 5.3 degrees");
}

TEST_F(JoinRigs, WhatCannotBeJoinedIsRefused) {
  const auto refusal = [this] { return refusalOf([this] { joinRigs(first_, second_); }); };
  first_.cameras[2].camera.identity = "00:19:1d:00:00:01";
  second_.cameras[0].camera.identity = "00:19:1d:00:00:02";
  EXPECT_SAYS(refusal(), "camera_3 is another device in the second rig");
  second_.cameras[0].camera.identity.clear();
  second_.cameras[2].camera.identity = "00:19:1d:00:00:01";
  EXPECT_SAYS(refusal(), "is called camera_5 in the second rig, but camera_3 in the first");
  second_.cameras[2].camera.identity.clear();
  second_.ray_model = geometry::RayModel::kImageCenter;
  EXPECT_SAYS(refusal(), "calibrate both with the same ray_model");
  second_.ray_model = geometry::RayModel::kCalibrated;
  second_.cameras[0].camera.name = "camera_7";
  second_.cameras[1].camera.name = "camera_8";
  EXPECT_SAYS(refusal(), "the rigs share no camera");
  second_.covariance.resize(0, 0);
  EXPECT_SAYS(refusal(), "the second rig does not say how certain");
}

TEST_F(JoinRigs, ClocksAreJoinedWhereASharedOneRanOn) {
  for (geometry::Rig* rig : {&first_, &second_}) {
    for (geometry::RigCamera& camera : rig->cameras) {
      camera.time_offset_rule = geometry::TimeOffsetRule::kOneEpoch;
      camera.time_offset_epoch = 5;
      camera.time_offset = 0.0;
    }
  }
  first_.cameras[3].time_offset = 0.004;
  second_.cameras[0].time_offset_epoch = 6;
  second_.cameras[1].time_offset = 0.001;
  second_.cameras[2].time_offset = 0.002;
  EXPECT_DOUBLE_EQ(joinRigs(first_, second_).rig.cameras[4].time_offset, 0.005);
  second_.cameras[1].time_offset_epoch = 6;
  const geometry::Rig rig = joinRigs(first_, second_).rig;
  EXPECT_TRUE(std::isnan(rig.cameras[4].time_offset));
  EXPECT_EQ(rig.cameras[4].time_offset_rule, geometry::TimeOffsetRule::kNone);
  EXPECT_EQ(rig.cameras[3].time_offset, 0.004);

  // Between the calibrations the driver was started again; then: it reconnected.
  first_.solved_at = 1000.0;
  second_.solved_at = 2000.0;
  second_.cameras[1].time_offset_epoch = 0;
  EXPECT_DOUBLE_EQ(joinRigs(first_, second_).rig.cameras[4].time_offset, 0.005);
  second_.solved_at = 500.0;
  EXPECT_TRUE(std::isnan(joinRigs(first_, second_).rig.cameras[4].time_offset));
}

/// Places in both rooms, measured with the second rig by perfect pixels.
std::vector<remap::KnownPoint> places(const geometry::Rig& second,
                                      double stddev,
                                      std::mt19937_64& random) {
  std::normal_distribution<double> normal(0.0, stddev);
  std::vector<remap::KnownPoint> result;
  for (const Eigen::Vector3d& truth :
       {Eigen::Vector3d(5.0, 1.0, 1.0), Eigen::Vector3d(5.8, 1.2, 0.6),
        Eigen::Vector3d(4.6, 1.9, 1.3), Eigen::Vector3d(5.2, 0.4, 1.5)}) {
    std::vector<geometry::Observation> observations;
    for (const geometry::RigCamera& camera : second.cameras) {
      for (const geometry::Camera& real : trueCameras()) {
        if (real.name == camera.camera.name && real.sees(truth))
          observations.push_back({&camera.camera, *real.project(truth)});
      }
    }
    const Eigen::Vector3d known =
        truth + Eigen::Vector3d(normal(random), normal(random), normal(random));
    result.push_back({geometry::triangulate(observations, {})->position, known});
  }
  return result;
}

TEST_F(JoinRigs, PlacesJoinRigsWithoutACommonCamera) {
  const geometry::Rig first = exactRig(0, 3, Eigen::Isometry3d::Identity(), random_);
  const geometry::Rig second = exactRig(3, 6, worldFromSecond(), random_);
  const int kRuns = 200;
  const Trials trials = trialsOf(kRuns, [&] {
    const geometry::Rig measuring = drawn(second, random_);
    return joinRigs(drawn(first, random_), measuring, places(measuring, 0.003, random_), 0.003);
  });
  EXPECT_LE(trials.refused, 2);
  EXPECT_NEAR(trials.square, 36.0, 4.0 * std::sqrt(72.0 / kRuns));
  EXPECT_NEAR(trials.disagreement, 6.0, 4.0 * std::sqrt(12.0 / kRuns));
}

TEST_F(JoinRigs, PlacesThatTellTooLittleOrContradictAreRefused) {
  const geometry::Rig first = exactRig(0, 3, Eigen::Isometry3d::Identity(), random_);
  const geometry::Rig second = exactRig(3, 6, worldFromSecond(), random_);
  std::vector<remap::KnownPoint> common = places(second, 0.003, random_);
  const auto refusal = [&] { return refusalOf([&] { joinRigs(first, second, common, 0.003); }); };
  common[2].known.z() += 0.2;
  EXPECT_SAYS(refusal(), "place 3 does not lie");
  common.resize(3);
  EXPECT_SAYS(refusal(), "the three common places do not lie");
  common[2].measured = common[0].measured + 2.0 * (common[1].measured - common[0].measured);
  EXPECT_SAYS(refusal(), "on one line");
  common[2].measured = worldFromSecond().inverse() * Eigen::Vector3d(5.0, 1.0, 8.0);
  EXPECT_SAYS(refusal(), "look at place 3");
  common.resize(2);
  EXPECT_SAYS(refusal(), "2 common places cannot determine");
}

}  // namespace
}  // namespace wiimote_tracker::rooms
