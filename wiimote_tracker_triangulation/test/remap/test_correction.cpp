// What a volume correction does to points, compared with formulas written out by hand.
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/remap/correction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace wiimote_tracker::remap {
namespace {

const char* const kRig = "0123456789abcdef";

/// The corners of a box from (0, 0, 0) to (2, 4, 2): the models' axes start in (1, 2, 1), and their
/// unit is 2 m.
std::vector<Eigen::Vector3d> box() {
  std::vector<Eigen::Vector3d> corners;
  for (const double z : {0.0, 2.0}) {
    for (const double y : {0.0, 4.0}) {
      for (const double x : {0.0, 2.0})
        corners.emplace_back(x, y, z);
    }
  }
  return corners;
}

/// x grows by half its distance from the middle, and everything is 0.1 m too low.
Remap stretched() {
  return {kRig, Model::kAffine, {0.0, 0.0, 0.1, 1.0, 0.0, 0.0, 0, 0, 0, 0, 0, 0}, box()};
}

Remap bent(Model model) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-0.05, 0.05);
  Remap remap{kRig, model, {}, box()};
  remap.parameters.resize(parameterCount(model, remap.support.size()));
  for (double& value : remap.parameters)
    value = uniform(random);
  if (model == Model::kProjective) {
    for (const std::size_t diagonal : {1U, 6U, 11U})
      remap.parameters[diagonal] += 2.0;
  }
  return remap;
}

TEST(Correction, a_point_inside_goes_where_the_model_says) {
  const Correction correction(stretched(), kRig);
  const auto point = correction.apply({1.6, 1.0, 0.5}, Eigen::Matrix3d::Identity());
  ASSERT_TRUE(point);
  EXPECT_TRUE(point->inside);
  EXPECT_LT((point->position - Eigen::Vector3d(1.9, 1.0, 0.6)).norm(), 1e-12);
  EXPECT_LT((point->covariance.diagonal() - Eigen::Vector3d(2.25, 1.0, 1.0)).norm(), 1e-12);
}

TEST(Correction, a_point_outside_is_displaced_as_the_border_before_it) {
  const Correction correction(stretched(), kRig);
  const auto point = correction.apply({101.0, 2.0, 1.0}, Eigen::Matrix3d::Identity());
  ASSERT_TRUE(point);
  EXPECT_FALSE(point->inside);
  // At the border, x = 2, the model adds 0.5.
  EXPECT_LT((point->position - Eigen::Vector3d(101.5, 2.0, 1.1)).norm(), 1e-12);
  // All along that line the displacement stays the same.
  EXPECT_NEAR(point->covariance(0, 0), 1.0, 1e-12);
}

TEST(Correction, nothing_jumps_at_the_border) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (const Model model :
       {Model::kAffine, Model::kProjective, Model::kTrilinear, Model::kThinPlate}) {
    SCOPED_TRACE(nameOf(model));
    const Correction correction(bent(model), kRig);
    for (int i = 0; i < 100; ++i) {
      // On the face x = 2.
      const Eigen::Vector3d border(2.0, 4.0 * uniform(random), 2.0 * uniform(random));
      const Eigen::Vector3d step(1e-7, 0.0, 0.0);
      const auto inside = correction.apply(border - step, Eigen::Matrix3d::Zero());
      const auto outside = correction.apply(border + step, Eigen::Matrix3d::Zero());
      ASSERT_TRUE(inside && outside);
      EXPECT_TRUE(inside->inside);
      EXPECT_FALSE(outside->inside);
      EXPECT_LT((outside->position - inside->position).norm(), 1e-6);
      EXPECT_GT((inside->position - border).norm(), 1e-3);
    }
  }
}

TEST(Correction, the_derivative_is_that_of_the_positions_inside_and_outside) {
  for (const Model model :
       {Model::kAffine, Model::kProjective, Model::kTrilinear, Model::kThinPlate}) {
    for (const Eigen::Vector3d& place :
         {Eigen::Vector3d(0.7, 1.6, 0.9), Eigen::Vector3d(2.9, 1.3, 1.2),
          Eigen::Vector3d(-1.0, -4.0, 0.4)}) {
      SCOPED_TRACE(std::string(nameOf(model)) + " " + std::to_string(place.x()));
      const Correction correction(bent(model), kRig);
      constexpr double kStep = 1e-6;
      Eigen::Matrix3d numeric;
      for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
        numeric.col(axis) = (correction.apply(place + step, Eigen::Matrix3d::Zero())->position -
                             correction.apply(place - step, Eigen::Matrix3d::Zero())->position) /
                            (2.0 * kStep);
      }
      const auto point = correction.apply(place, Eigen::Matrix3d::Identity());
      EXPECT_LT((point->jacobian - numeric).norm(), 1e-8);
      EXPECT_LT((point->covariance - numeric * numeric.transpose()).norm(), 1e-7);
    }
  }
}

TEST(Correction, points_that_are_not_finite_are_not_corrected) {
  const Correction correction(stretched(), kRig);
  EXPECT_FALSE(correction.apply({NAN, 1.0, 1.0}, Eigen::Matrix3d::Identity()));
  EXPECT_FALSE(correction.apply({1.0, HUGE_VAL, 1.0}, Eigen::Matrix3d::Identity()));
}

TEST(Correction, another_calibration_and_damage_are_refused_with_different_texts) {
  const auto says = [](const Remap& remap, const std::string& rig, const std::string& part) {
    try {
      Correction(remap, rig);
    } catch (const Error& e) {
      return std::string(e.what()).find(part) != std::string::npos;
    }
    return false;
  };
  EXPECT_NO_THROW(Correction(stretched(), kRig));
  EXPECT_TRUE(says(stretched(), "fedcba9876543210", "void"));
  Remap bad = stretched();
  bad.rig_id.clear();
  EXPECT_TRUE(says(bad, "", "void"));
  bad = stretched();
  bad.parameters.pop_back();
  EXPECT_TRUE(says(bad, kRig, "11 parameters, but affine needs 12"));
  bad = stretched();
  bad.parameters[3] = NAN;
  EXPECT_TRUE(says(bad, kRig, "not finite"));
  bad = stretched();
  for (Eigen::Vector3d& point : bad.support)
    point.z() = 0.0;
  EXPECT_TRUE(says(bad, kRig, "no volume"));
  bad = bent(Model::kProjective);
  bad.parameters[12] = 10.0;  // the vanishing plane, where 2 + 10 qx is 0, cuts the box
  EXPECT_TRUE(says(bad, kRig, "infinity"));
}

}  // namespace
}  // namespace wiimote_tracker::remap
