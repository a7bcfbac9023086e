// What the calibrations share: the path's pixel and its derivatives, covariances, and quantiles.
#include "adjust/chi_squared.h"
#include "adjust/corner.h"
#include "adjust/covariance.h"
#include "adjust/path.h"
#include "adjust/prior.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

namespace wiimote_tracker::adjust {
namespace {

TEST(PathPixel, DerivativesAreThoseOfFiniteDifferencesForEveryLens) {
  for (const auto model : geometry::kDistortionModels) {
    SCOPED_TRACE(geometry::nameOf(model));
    geometry::Camera camera;
    camera.world_from_camera =
        geometry::lookAt({3.0, -2.0, 2.0}, {1.0, 1.0, 0.5}, Eigen::Vector3d::UnitZ());
    camera.intrinsics.distortion_model = model;
    const PixelError pixel(CameraBlocks(camera), {400.0, 300.0}, 0.4);
    // The time offset moves the exposure beyond the knot interval.
    const std::unique_ptr<ceres::CostFunction> error(PathPixelError{pixel, 0.045, 0.05}.cost());
    std::vector<std::vector<double>> blocks = {{0.02, -0.01, 0.03},
                                               {3.0, -2.0, 2.0},
                                               {500.0, 510.0, 520.0, 390.0, -0.05},
                                               {0.01, 0.002, -0.001, 0.0},
                                               {0.02},
                                               {0.9, 1.3, 0.7},
                                               {1.0, 1.1, 0.8},
                                               {1.2, 1.0, 0.8},
                                               {1.5, 0.9, 0.9}};
    std::vector<std::vector<double>> jacobians;
    std::vector<double*> parameters;
    std::vector<double*> derivatives;
    for (std::vector<double>& block : blocks) {
      jacobians.emplace_back(2 * block.size());
      parameters.push_back(block.data());
    }
    for (std::vector<double>& jacobian : jacobians)
      derivatives.push_back(jacobian.data());
    std::array<double, 2> residual{};
    ASSERT_TRUE(error->Evaluate(parameters.data(), residual.data(), derivatives.data()));
    constexpr double kStep = 1e-6;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const std::size_t size = blocks[b].size();
      for (std::size_t k = 0; k < size; ++k) {
        const double here = blocks[b][k];
        std::array<double, 2> plus{};
        std::array<double, 2> minus{};
        blocks[b][k] = here + kStep;
        error->Evaluate(parameters.data(), plus.data(), nullptr);
        blocks[b][k] = here - kStep;
        error->Evaluate(parameters.data(), minus.data(), nullptr);
        blocks[b][k] = here;
        for (std::size_t row = 0; row < 2; ++row)
          EXPECT_NEAR(jacobians[b][row * size + k], (plus[row] - minus[row]) / (2.0 * kStep), 1e-3)
              << b << " " << k << " " << row;
      }
    }
  }
}

TEST(TapedLength, IsTheDistanceOfTheDisplacedCornersLessTheTape) {
  const TapedLengthError error{{2.5, 2.5}, 5.0, 0.01};
  const std::array<double, 2> from = {-0.5, 0.0};
  std::array<double, 2> to = {0.0, 1.5};
  double residual = 0.0;
  ASSERT_TRUE(error(from.data(), to.data(), &residual));
  EXPECT_NEAR(residual, 0.0, 1e-9);
  to[1] = 0.0;  // now 3 and 2.5
  ASSERT_TRUE(error(from.data(), to.data(), &residual));
  EXPECT_NEAR(residual, (std::hypot(3.0, 2.5) - 5.0) / 0.01, 1e-9);
  to = {-3.0, -2.5};
  EXPECT_FALSE(error(from.data(), to.data(), &residual));
}

/// a + 2 b + c, with standard deviation 1.
struct Sum {
  template <typename T>
  bool operator()(const T* a, const T* b, const T* c, T* residual) const {
    *residual = *a + 2.0 * *b + *c;
    return true;
  }
};

class CovarianceOf : public testing::Test {
 protected:
  CovarianceOf() {
    problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<Sum, 1, 1, 1, 1>(new Sum), nullptr,
                              &a_, &b_, &c_);
    problem_.SetParameterBlockConstant(&c_);
  }

  ceres::Problem problem_;
  double a_ = 0.0;
  double b_ = 0.0;
  double c_ = 0.0;
};

TEST_F(CovarianceOf, IsTheInverseOfTheInformationInTheOrderAskedFor) {
  problem_.AddResidualBlock(priorOf(0.0, 1e-3), nullptr, &a_);
  // Given a, b is known to half of the sum's error.
  const auto covariance = covarianceOf(&problem_, {&b_, &c_, &a_});
  ASSERT_TRUE(covariance);
  Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
  expected(0, 0) = 0.25 + 0.25e-6;
  expected(2, 2) = 1e-6;
  expected(0, 2) = expected(2, 0) = -0.5e-6;
  EXPECT_LT((*covariance - expected).norm(), 1e-12);
  const auto part = covarianceOf(&problem_, {&a_});
  ASSERT_TRUE(part);
  EXPECT_NEAR((*part)(0, 0), 1e-6, 1e-15);
}

TEST_F(CovarianceOf, IsNothingWhereSomeParameterIsOpen) {
  EXPECT_FALSE(covarianceOf(&problem_, {&a_}));
}

TEST(ChiSquared, QuantilesOfTheTables) {
  EXPECT_NEAR(chiSquaredQuantile(3, kTwoNines), 11.345, 0.03);
  EXPECT_NEAR(chiSquaredQuantile(5, kThreeNines), 20.515, 0.25);
  EXPECT_NEAR(chiSquaredQuantile(1, kTwoNines), 6.635, 0.1);
}

}  // namespace
}  // namespace wiimote_tracker::adjust
