// Corrections of the volume: recovered exactly, chosen honestly, never used silently where they do
// not hold. All simulated.

#include "deformations.h"
#include "expect_says.h"
#include "remap/measured_points.h"
#include "wiimote_tracker_calibration/remap/fit.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_triangulation/remap/correction.h>
#include <wiimote_tracker_triangulation/remap/model_math.h>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <cmath>
#include <functional>
#include <random>

namespace wiimote_tracker::remap {
namespace {

const char* const kRig = "0123456789abcdef";

using Deformation = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;  // measured -> known

Eigen::Vector3d inCube(Random& random, double from, double to) {
  std::uniform_real_distribution<double> uniform(from, to);
  const double x = uniform(random);
  const double y = uniform(random);
  return Eigen::Vector3d(x, y, uniform(random));
}

/// Three by three by three measured points in the 2.5 m cube, a little off a grid.
std::vector<Eigen::Vector3d> grid(Random& random) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 27; ++i)
    points.push_back(1.25 * Eigen::Vector3i(i % 3, i / 3 % 3, i / 9).cast<double>() +
                     noise(random, 0.02));
  return points;
}

std::vector<KnownPoint> deformed(const std::vector<Eigen::Vector3d>& measured,
                                 const Deformation& deformation) {
  std::vector<KnownPoint> points;
  for (const Eigen::Vector3d& point : measured)
    points.push_back({point, deformation(point)});
  return points;
}

Eigen::Vector3d affine(const Eigen::Vector3d& p) {
  Eigen::Matrix3d matrix;
  matrix << 1.02, 0.03, -0.01, -0.02, 0.97, 0.02, 0.01, -0.03, 1.04;
  return matrix * p + Eigen::Vector3d(0.05, -0.1, 0.07);
}

Eigen::Vector3d projective(const Eigen::Vector3d& p) {
  return affine(p) / (1.0 + 0.02 * p.x() - 0.03 * p.y() + 0.015 * p.z());
}

Eigen::Vector3d trilinear(const Eigen::Vector3d& p) {
  return affine(p) + 0.02 * p.x() * p.y() * Eigen::Vector3d(1.0, -0.5, 0.2) +
         0.01 * p.y() * p.z() * Eigen::Vector3d(-0.3, 1.0, 0.4) +
         0.015 * p.x() * p.y() * p.z() * Eigen::Vector3d(0.5, 0.5, -1.0);
}

TEST(Remap, EachModelRecoversItsOwnDeformationExactlyAndIsChosen) {
  const std::vector<std::pair<Model, Deformation>> cases = {
      {Model::kAffine, affine}, {Model::kProjective, projective}, {Model::kTrilinear, trilinear}};
  for (const auto& [model, deformation] : cases) {
    SCOPED_TRACE(nameOf(model));
    Random random(5);
    const FitResult result = fitRemap(deformed(grid(random), deformation), kRig);
    EXPECT_EQ(result.remap.model, model);
    EXPECT_LT(result.expected_error, 1e-9);
    const Correction correction(result.remap, kRig);
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3d point = inCube(random, 0.2, 2.3);
      const auto corrected = correction.apply(point, Eigen::Matrix3d::Zero());
      ASSERT_TRUE(corrected.has_value());
      EXPECT_LT((corrected->position - deformation(point)).norm(), 1e-9);
    }
  }
}

// The thin plate through given values at its own points is unique.
TEST(Remap, AThinPlateRecoversItsOwnDeformationExactly) {
  Random random(5);
  const std::vector<Eigen::Vector3d> measured = grid(random);
  const std::vector<Model> allowed = {Model::kThinPlate};
  const Correction truth(fitRemap(deformed(measured, wavy), kRig, allowed).remap, kRig);
  const Deformation plate = [&](const Eigen::Vector3d& p) {
    return truth.apply(p, Eigen::Matrix3d::Zero())->position;
  };
  const Correction correction(fitRemap(deformed(measured, plate), kRig, allowed).remap, kRig);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d point = inCube(random, 0.0, 2.5);
    const auto corrected = correction.apply(point, Eigen::Matrix3d::Zero());
    EXPECT_LT((corrected->position - plate(point)).norm(), 1e-9);
  }
}

TEST(Remap, AThinPlateIsChosenForWhatNoOtherModelCan) {
  Random random(6);
  const std::vector<Eigen::Vector3d> measured = grid(random);
  const std::vector<KnownPoint> points = deformed(measured, wavy);
  const FitResult result = fitRemap(points, kRig);
  EXPECT_EQ(result.remap.model, Model::kThinPlate);
  EXPECT_LT(result.models.back().fit_error, 0.005);
  const Correction correction(result.remap, kRig);
  double squared = 0.0;
  double before = 0.0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d point = inCube(random, 0.2, 2.3);
    const auto corrected = correction.apply(point, Eigen::Matrix3d::Zero());
    squared += (corrected->position - wavy(point)).squaredNorm() / 500.0;
    before += (point - wavy(point)).squaredNorm() / 500.0;
  }
  EXPECT_LT(std::sqrt(squared), 0.3 * std::sqrt(before));
  // Left out points are harder than points inside: the expected error does not flatter.
  EXPECT_GT(result.expected_error, std::sqrt(squared));
  EXPECT_LT(result.expected_error, std::sqrt(before));
}

// The closed form for left out points, against fitting without each point in turn.
TEST(Remap, LeftOutErrorsOfAThinPlateAreThoseOfFitsWithoutThePoint) {
  Random random(7);
  const std::vector<Model> allowed = {Model::kThinPlate};
  std::vector<KnownPoint> points = deformed(grid(random), wavy);
  const FitResult all = fitRemap(points, kRig, allowed);
  for (const std::size_t left_out : {0U, 13U, 26U}) {
    std::vector<KnownPoint> others = points;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(left_out));
    const FitResult without = fitRemap(others, kRig, allowed);
    // Some of these lie outside the others: the model itself is asked, not what is published.
    const auto predicted =
        evaluate(without.remap, frameOf(without.remap.support), points[left_out].measured);
    const double error = (predicted->position - points[left_out].known).norm();
    EXPECT_NEAR(all.left_out_errors[left_out], error, 0.05 * error + 1e-6);
  }
}

TEST(ExtensiveRemap, WithNoiseTheSimplestSufficientModelIsMostlyChosen) {
  constexpr int kTrials = 20;
  int affine_chosen = 0;
  int trilinear_chosen = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    Random random(static_cast<std::uint64_t>(100 + trial));
    const auto chosen = [&](const Deformation& deformation) {
      std::vector<KnownPoint> points = deformed(grid(random), deformation);
      for (KnownPoint& point : points)
        point.measured += noise(random, 0.003);
      return fitRemap(points, kRig).remap.model;
    };
    affine_chosen += chosen(affine) == Model::kAffine;
    trilinear_chosen += chosen(trilinear) == Model::kTrilinear;
  }
  EXPECT_GE(affine_chosen, kTrials * 7 / 10);
  EXPECT_GE(trilinear_chosen, kTrials * 7 / 10);
}

// What is promised for a point is what new points, measured with the same noise, are found to be.
TEST(ExtensiveRemap, TheExpectedErrorIsHonest) {
  constexpr int kTrials = 20;
  double promised = 0.0;
  double found = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    Random random(static_cast<std::uint64_t>(200 + trial));
    std::vector<KnownPoint> points = deformed(grid(random), trilinear);
    for (KnownPoint& point : points)
      point.known += noise(random, 0.005);
    const FitResult result = fitRemap(points, kRig);
    promised += result.expected_error * result.expected_error / kTrials;
    const Correction correction(result.remap, kRig);
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector3d point = inCube(random, 0.1, 2.4);
      const Eigen::Vector3d known = trilinear(point) + noise(random, 0.005);
      const auto corrected = correction.apply(point, Eigen::Matrix3d::Zero());
      found += (corrected->position - known).squaredNorm() / (50.0 * kTrials);
    }
  }
  const double ratio = std::sqrt(promised / found);
  RecordProperty("ratio", std::to_string(ratio));
  EXPECT_GT(ratio, 0.95);
  EXPECT_LT(ratio, 1.5);
}

TEST(Remap, ThePapersTenPointsSufficeForEveryModel) {
  std::vector<Eigen::Vector3d> measured;
  for (int i = 0; i < 8; ++i)
    measured.push_back(2.5 * Eigen::Vector3d(i & 1, i >> 1 & 1, i >> 2 & 1));
  measured.emplace_back(1.25, 1.25, 0.0);
  measured.emplace_back(1.25, 1.25, 1.5);
  const FitResult result = fitRemap(deformed(measured, trilinear), kRig);
  ASSERT_EQ(result.models.size(), 4U);
  for (const ModelReport& model : result.models)
    EXPECT_TRUE(model.usable) << nameOf(model.model) << ": " << model.reason;
  EXPECT_LT(result.left_out_errors[9], 0.2);
  EXPECT_NE(table(result).find("chosen"), std::string::npos);
}

TEST(Remap, PointsOnTheOutsideAloneAreWarnedOf) {
  Random random(17);
  std::vector<Eigen::Vector3d> measured;
  for (int i = 0; i < 8; ++i)
    measured.push_back(2.5 * Eigen::Vector3d(i & 1, i >> 1 & 1, i >> 2 & 1) + noise(random, 0.01));
  const auto warns = [&] {
    for (const std::string& warning : fitRemap(deformed(measured, affine), kRig).warnings) {
      if (warning.find("inside the others") != std::string::npos)
        return true;
    }
    return false;
  };
  EXPECT_TRUE(warns());
  measured.emplace_back(1.25, 1.25, 1.5);
  EXPECT_FALSE(warns());
}

TEST(Remap, CovarianceFollowsTheDerivativeOfTheModel) {
  Random random(8);
  const std::vector<Eigen::Vector3d> measured = grid(random);
  const std::vector<std::pair<Model, Deformation>> cases = {{Model::kAffine, affine},
                                                            {Model::kProjective, projective},
                                                            {Model::kTrilinear, trilinear},
                                                            {Model::kThinPlate, wavy}};
  Eigen::Matrix3d covariance;
  covariance << 4e-6, 1e-6, 0.0, 1e-6, 9e-6, 2e-6, 0.0, 2e-6, 1e-6;
  for (const auto& [model, deformation] : cases) {
    SCOPED_TRACE(nameOf(model));
    const Correction correction(fitRemap(deformed(measured, deformation), kRig, {model}).remap,
                                kRig);
    const Eigen::Vector3d point(0.7, 1.6, 0.9);
    Eigen::Matrix3d jacobian;
    constexpr double kStep = 1e-5;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
      jacobian.col(axis) = (correction.apply(point + step, covariance)->position -
                            correction.apply(point - step, covariance)->position) /
                           (2.0 * kStep);
    }
    const auto corrected = correction.apply(point, covariance);
    EXPECT_LT((corrected->jacobian - jacobian).norm(), 1e-8);
    EXPECT_LT((corrected->covariance - jacobian * covariance * jacobian.transpose()).norm(), 1e-13);
    EXPECT_GT((corrected->covariance - covariance).norm(), 1e-9);
  }
}

TEST(Remap, OutsideTheHullIsSaid) {
  Random random(9);
  const FitResult result = fitRemap(deformed(grid(random), trilinear), kRig);
  const Correction correction(result.remap, kRig);
  const Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  EXPECT_TRUE(correction.apply({1.2, 1.3, 1.1}, covariance)->inside);
  for (const Eigen::Vector3d& outside :
       {Eigen::Vector3d(-0.2, 1.0, 1.0), Eigen::Vector3d(1.0, 1.0, 2.8),
        Eigen::Vector3d(2.7, 2.7, 2.7)})
    EXPECT_FALSE(correction.apply(outside, covariance)->inside);
  EXPECT_FALSE(correction.apply({NAN, 1.0, 1.0}, covariance).has_value());
}

TEST(Remap, AnotherCalibrationAndDamagedValuesAreRefused) {
  Random random(11);
  const Remap good = fitRemap(deformed(grid(random), affine), kRig).remap;
  EXPECT_NO_THROW(Correction(good, kRig));
  try {
    const Correction correction(good, "fedcba9876543210");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("void"), std::string::npos);
  }
  Remap bad = good;
  bad.rig_id.clear();
  EXPECT_THROW(Correction(bad, ""), Error);
  bad = good;
  bad.parameters.pop_back();
  EXPECT_THROW(Correction(bad, kRig), Error);
  bad = good;
  bad.parameters[3] = NAN;
  EXPECT_THROW(Correction(bad, kRig), Error);
  bad = good;
  for (Eigen::Vector3d& point : bad.support)
    point.z() = 0.0;
  EXPECT_THROW(Correction(bad, kRig), Error);
  EXPECT_EQ(modelFromName("thin_plate"), Model::kThinPlate);
  EXPECT_THROW(modelFromName("quadratic"), Error);
}

void expectRefused(const std::vector<KnownPoint>& points, const std::string& part) {
  try {
    fitRemap(points, kRig);
    FAIL() << "not refused: " << part;
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(Remap, EachKindOfUselessPointsHasItsOwnRefusal) {
  Random random(12);
  const std::vector<Eigen::Vector3d> measured = grid(random);
  const std::vector<KnownPoint> good = deformed(measured, affine);

  expectRefused({good.begin(), good.begin() + 5}, "too few");
  expectRefused(std::vector<KnownPoint>(501, good[0]), "at most 500");
  std::vector<KnownPoint> bad = good;
  for (KnownPoint& point : bad)
    point.known.z() = 0.0;
  for (std::size_t i = 0; i < bad.size(); ++i)
    bad[i].known.x() += 0.01 * static_cast<double>(i);
  expectRefused(bad, "the known points lie in one plane");
  bad.clear();
  for (int i = 0; i < 10; ++i)
    bad.push_back({Eigen::Vector3d(0.1 * i, 0.2 * i, 0.0), Eigen::Vector3d(0.1 * i, 0.0, 0.0)});
  expectRefused(bad, "on one line");
  bad = good;
  for (KnownPoint& point : bad)
    point.known.y() = -point.known.y();
  expectRefused(bad, "mirror image");
  bad.clear();
  for (const Eigen::Vector3d& point : measured)
    bad.push_back({point, point + noise(random, 0.002)});
  expectRefused(bad, "better than none");
}

TEST(Remap, AModelThatNeedsMorePointsSaysSoAndTheOthersAreUsed) {
  Random random(13);
  const std::vector<Eigen::Vector3d> measured = {{0.0, 0.0, 0.0}, {2.5, 0.1, 0.0}, {0.0, 2.5, 0.1},
                                                 {2.4, 2.5, 0.0}, {0.1, 0.0, 2.5}, {2.5, 0.0, 2.4},
                                                 {1.2, 1.3, 1.1}};
  const FitResult result = fitRemap(deformed(measured, affine), kRig);
  EXPECT_EQ(result.remap.model, Model::kAffine);
  ASSERT_EQ(result.models.size(), 4U);
  EXPECT_FALSE(result.models[2].usable);
  EXPECT_NE(result.models[2].reason.find("needs 10 points"), std::string::npos);
  EXPECT_NE(table(result).find("needs 10 points"), std::string::npos);
}

TEST(Remap, AWrongPointIsNamed) {
  Random random(14);
  std::vector<KnownPoint> points = deformed(grid(random), affine);
  for (KnownPoint& point : points)
    point.known += noise(random, 0.002);
  points[16].known.x() += 0.1;
  const FitResult result = fitRemap(points, kRig);
  ASSERT_FALSE(result.warnings.empty());
  EXPECT_NE(result.warnings[0].find("known point 17"), std::string::npos);
}

TEST(MeasuredPoints, AreNotTakenTwice) {
  MeasuredPoints points;
  const Eigen::Vector3d first(0.4, 0.4, 0.1);
  const Eigen::Vector3d second(2.1, 0.4, 0.1);
  points.add({first, first});
  EXPECT_NO_THROW(points.requireNew(second));
  EXPECT_EQ(points.describeUnmoved({second, second}), "");
  EXPECT_SAYS(points.describeUnmoved({first, second}), "where place 1 was measured");
  points.add({second, second});
  try {
    points.requireNew(second);
    ADD_FAILURE() << "not refused";
  } catch (const Error& e) {
    EXPECT_SAYS(std::string(e.what()), "place 2 has these coordinates already");
  }
}

TEST(MeasuredPoints, BelongToOneCalibration) {
  MeasuredPoints points;
  EXPECT_EQ(points.useRig("first"), 0U);
  points.add({Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()});
  points.add({Eigen::Vector3d::Ones(), Eigen::Vector3d::Ones()});
  EXPECT_EQ(points.useRig("first"), 0U);
  EXPECT_EQ(points.points().size(), 2U);
  EXPECT_TRUE(points.undo());
  EXPECT_EQ(points.points().size(), 1U);
  EXPECT_EQ(points.useRig("second"), 1U);
  EXPECT_FALSE(points.undo());
}

}  // namespace
}  // namespace wiimote_tracker::remap
