#include "motion/filter_scene.h"
#include "motion/textbook_imm.h"

#include <gtest/gtest.h>
#include <Eigen/LU>

#include <cmath>

namespace wiimote_tracker::motion::test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::Camera;
using geometry::test::Random;

/// That an uncertain time adds its variance times the second moment of the pixel's velocity.
void expectNoiseAlongTheMotion(const MotionFilter& filter, const Camera& camera) {
  constexpr double kStampStddev = 0.003;
  const auto exact = filter.predictPixel(camera, {kPixelStddev, 0.0});
  const auto smeared = filter.predictPixel(camera, {kPixelStddev, kStampStddev});
  ASSERT_TRUE(exact && smeared);
  Eigen::Matrix<double, 2, 3> derivative;  // by differences
  constexpr double kSmall = 1e-4;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d step = kSmall * Vector3d::Unit(axis);
    derivative.col(axis) =
        (*camera.project(filter.position() + step) - *camera.project(filter.position() - step)) /
        (2.0 * kSmall);
  }
  const Matrix3d moment =
      filter.velocityCovariance() + filter.velocity() * filter.velocity().transpose();
  const Eigen::Matrix2d expected =
      kStampStddev * kStampStddev * derivative * moment * derivative.transpose();
  EXPECT_LT(relative(smeared->covariance() - exact->covariance(), expected), 1e-4);
}

TEST(PixelPrediction, IsTheMixturesDensityAndMoments) {
  const Camera camera = ring()[1];
  MotionFilter filter(kDefault, 0.0, {0.1, 0.2, 0.3}, 1e-6 * Matrix3d::Identity());
  Random random(3);
  for (int i = 1; i < 200; ++i) {
    const double time = kStep * i;
    ASSERT_TRUE(
        takeIn(&filter, time, ring()[i % 4], noisyPixel(ring()[i % 4], variedPath(time), random)));
  }
  filter.predict(filter.time() + 0.02);
  const auto prediction = filter.predictPixel(camera, {kPixelStddev, 0.0});
  ASSERT_TRUE(prediction);
  // Integrated on a grid that reaches far enough.
  constexpr double kCell = 0.1;
  double sum = 0.0;
  Vector2d mean = Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (double u = -40.0; u <= 40.0; u += kCell) {
    for (double v = -40.0; v <= 40.0; v += kCell) {
      const Vector2d d(u, v);
      const double share =
          std::exp(prediction->logLikelihood(prediction->pixel() + d)) * kCell * kCell;
      sum += share;
      mean += share * d;
      second += share * d * d.transpose();
    }
  }
  EXPECT_NEAR(1.0, sum, 1e-3);
  EXPECT_LT(mean.norm(), 1e-3);
  EXPECT_LT(relative(prediction->covariance(), second), 0.01);
  EXPECT_EQ(*camera.project(filter.position()), prediction->pixel());
  EXPECT_TRUE(std::isnan(prediction->squaredDistance({NAN, 0.0})));
}

TEST(PixelPrediction, AGateAcceptsExactlyThePixelsWithin) {
  const Camera camera = ring()[1];
  MotionFilter filter(kDefault, 0.0, {0.1, 0.2, 0.3}, 1e-6 * Matrix3d::Identity());
  Random random(13);
  int within = 0;
  for (int i = 1; i < 400; ++i) {
    const double time = kStep * i;
    filter.predict(time);
    const auto prediction = filter.predictPixel(camera, {kPixelStddev, 0.001});
    ASSERT_TRUE(prediction);
    for (const double gate : {1.0, 4.0, 25.0, 100.0}) {
      for (int j = 0; j < 20; ++j) {
        const double range = std::pow(10.0, random.uniform(-1.0, 3.0));  // [px]
        const Vector2d pixel =
            prediction->pixel() + range * Vector2d(random.gaussian(), random.gaussian());
        const auto likelihood = prediction->logLikelihoodWithin(gate, pixel);
        ASSERT_EQ(prediction->squaredDistance(pixel) <= gate, likelihood.has_value()) << gate;
        if (likelihood) {
          EXPECT_EQ(prediction->logLikelihood(pixel), *likelihood);
        }
        within += likelihood.has_value();
      }
    }
    EXPECT_FALSE(prediction->logLikelihoodWithin(1e9, {NAN, 0.0}));
    ASSERT_TRUE(filter.update(camera, *prediction, noisyPixel(camera, variedPath(time), random)));
  }
  EXPECT_GT(within, 3000);
}

TEST(PixelPrediction, AnUncertainStampAddsNoiseAlongTheMotion) {
  const std::vector<Camera> cameras = ring();
  MotionFilter filter(kDefault, 0.0, Vector3d(-0.2, 0.0, 0.1), 1e-6 * Matrix3d::Identity());
  Random random(4);
  const Vector3d velocity(1.0, 0.5, -0.2);
  for (int i = 1; i < 100; ++i) {
    const Vector3d truth = Vector3d(-0.2, 0.0, 0.1) + velocity * kStep * i;
    ASSERT_TRUE(
        takeIn(&filter, kStep * i, cameras[i % 4], noisyPixel(cameras[i % 4], truth, random)));
  }
  expectNoiseAlongTheMotion(filter, cameras[0]);
}

// It goes on at up to initial_speed in the direction that nobody knows yet.
TEST(PixelPrediction, AnUncertainStampAddsNoiseWhereTheVelocityIsUnknown) {
  const MotionFilter filter(kDefault, 0.0, Vector3d(-0.2, 0.0, 0.1), 1e-6 * Matrix3d::Identity());
  EXPECT_EQ(Vector3d::Zero(), filter.velocity());
  expectNoiseAlongTheMotion(filter, ring()[0]);
}

}  // namespace
}  // namespace wiimote_tracker::motion::test
