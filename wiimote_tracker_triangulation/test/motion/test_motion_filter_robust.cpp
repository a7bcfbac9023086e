// Order, copies and absurd input make no difference that they ought not to make; nothing is
// allocated.
#include "allocation_counter.h"

#include "motion/filter_scene.h"
#include "tracking/paths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

namespace wiimote_tracker::motion::test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::Camera;
using geometry::test::Random;

TEST(MotionFilter, TheOrderOfImagesOfOneTimeMakesNoDifference) {
  const std::vector<Camera> cameras = ring();
  Random random(9);
  MotionFilter filter(kDefault, 0.0, variedPath(0.0), 1e-6 * Matrix3d::Identity());
  for (int i = 1; i < 250; ++i)
    ASSERT_TRUE(takeIn(&filter, kStep * i, cameras[i % 4],
                       noisyPixel(cameras[i % 4], variedPath(kStep * i), random)));
  const double time = filter.time() + 0.01;
  std::vector<Vector2d> pixels;
  for (const Camera& camera : cameras)
    pixels.push_back(noisyPixel(camera, variedPath(time), random));
  MotionFilter forwards = filter, backwards = filter;
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(takeIn(&forwards, time, cameras[i], pixels[i]));
    ASSERT_TRUE(takeIn(&backwards, time, cameras[3 - i], pixels[3 - i]));
  }
  // They differ only in the point of linearisation: a small part of the standard deviation.
  const double stddev = std::sqrt(forwards.positionCovariance().trace());
  EXPECT_LT((forwards.position() - backwards.position()).norm(), 0.01 * stddev);
  EXPECT_LT(relative(forwards.positionCovariance(), backwards.positionCovariance()), 0.01);
  EXPECT_NEAR(restProbability(forwards), restProbability(backwards), 0.01);
}

TEST(MotionFilter, ACopyIsIndependentAndTheSame) {
  const std::vector<Camera> cameras = ring();
  Random random(10);
  MotionFilter filter(kDefault, 0.0, variedPath(0.0), 1e-6 * Matrix3d::Identity());
  const auto goOn = [&](MotionFilter* f, int from, unsigned seed) {
    Random noise(seed);
    for (int i = from; i < from + 100; ++i)
      ASSERT_TRUE(takeIn(f, kStep * i, cameras[i % 4],
                         noisyPixel(cameras[i % 4], variedPath(kStep * i), noise)));
  };
  goOn(&filter, 1, 11);
  const MotionFilter kept = filter;
  const Vector3d position = kept.position();
  goOn(&filter, 101, 12);
  EXPECT_EQ(position, kept.position());
  MotionFilter again = kept;
  goOn(&again, 101, 12);
  EXPECT_EQ(filter.position(), again.position());
  EXPECT_EQ(filter.positionCovariance(), again.positionCovariance());
  EXPECT_EQ(filter.velocity(), again.velocity());
}

TEST(MotionFilter, AbsurdInputIsRefusedOrSurvived) {
  const Camera camera = ring()[0];
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  MotionFilter filter(kDefault, 10.0, Vector3d::Zero(), 1e-6 * Matrix3d::Identity());
  for (const double time : {nan, infinity, -infinity, 9.0, 10.0})
    filter.predict(time);
  EXPECT_EQ(10.0, filter.time());
  const auto prediction = filter.predictPixel(camera, {kPixelStddev, 0.0});
  ASSERT_TRUE(prediction);
  const Vector3d position = filter.position();
  for (const Vector2d& pixel : {Vector2d(nan, 0.0), Vector2d(0.0, infinity), Vector2d(1e300, 0.0)})
    EXPECT_FALSE(filter.update(camera, *prediction, pixel));
  EXPECT_EQ(position, filter.position());
  EXPECT_TRUE(filter.update(camera, *prediction, {1e6, -1e6}));
  EXPECT_TRUE(filter.position().allFinite());
  EXPECT_TRUE(filter.velocity().allFinite());
  EXPECT_TRUE(filter.positionCovariance().allFinite());
  filter.predict(10.0 + 1e9);
  EXPECT_TRUE(filter.positionCovariance().allFinite());

  const MotionFilter behind(kDefault, 0.0, 2.0 * camera.center(), 1e-6 * Matrix3d::Identity());
  EXPECT_FALSE(behind.predictPixel(camera, {kPixelStddev, 0.0}));
}

TEST(MotionFilter, StaysFiniteForAnySpot) {
  // Successive spots beyond any gate, at any distance in time and image; also with modes left out.
  const std::vector<Camera> cameras = ring();
  Random random(15);
  for (int run = 0; run < 300; ++run) {
    MotionOptions options;
    if (run % 3 == 1)
      options.sudden_random_walk = 0.0;
    if (run % 5 == 1)
      options.stop_rate = 0.0;
    if (run % 7 == 1)
      options.rise_rate = options.settle_rate = options.rest[0].start_rate = 0.0;
    const double stddev = std::pow(10.0, random.uniform(-4.0, 0.0));
    MotionFilter filter(options, 0.0, random.inBox(0.5), stddev * stddev * Matrix3d::Identity());
    double time = 0.0;
    for (int i = 0; i < 60; ++i) {
      time += i % 3 == 0 ? 0.0 : std::pow(10.0, random.uniform(-6.0, run % 2 == 0 ? -1.0 : 3.0));
      filter.predict(time);
      const Camera& camera = cameras[static_cast<std::size_t>(random.uniform(0.0, 3.999))];
      const auto prediction = filter.predictPixel(
          camera, {std::pow(10.0, random.uniform(-3, 2)), run % 4 == 0 ? 0.01 : 0.0});
      if (!prediction)
        continue;
      const double range = std::pow(10.0, random.uniform(-1.0, 6.0));  // [px]
      const Vector2d pixel =
          prediction->pixel() + range * Vector2d(random.gaussian(), random.gaussian());
      ASSERT_FALSE(std::isnan(prediction->logLikelihood(pixel))) << run << " " << i;
      filter.update(camera, *prediction, pixel);
      ASSERT_TRUE(filter.position().allFinite()) << run << " " << i;
      ASSERT_TRUE(filter.positionCovariance().allFinite()) << run << " " << i;
      ASSERT_TRUE(filter.velocityCovariance().allFinite()) << run << " " << i;
      ASSERT_TRUE(restProbability(filter) >= 0.0 && restProbability(filter) <= 1.0 + 1e-9);
    }
  }
}

TEST(MotionFilter, DoesNotAllocate) {
  const std::vector<Camera> cameras = ring();
  const int start = g_allocations;
  const auto something = std::make_unique<Eigen::MatrixXd>(9, 9);
  EXPECT_EQ(81, something->size());
  EXPECT_EQ(start + 2, g_allocations);  // it counts
  Random random(13);
  std::vector<Vector2d> pixels;
  for (int i = 0; i < 400; ++i)
    pixels.push_back(noisyPixel(cameras[i % 4], variedPath(kStep * i), random));
  const int before = g_allocations;
  MotionFilter filter(kDefault, 0.0, variedPath(0.0), Matrix3d::Identity());
  double sum = 0.0;
  for (int i = 1; i < 400; ++i) {
    takeIn(&filter, kStep * i, cameras[i % 4], pixels[i]);
    sum += filter.positionCovariance().trace() + filter.velocityCovariance().trace();
  }
  EXPECT_EQ(before, g_allocations);
  EXPECT_GT(sum, 0.0);
}

}  // namespace
}  // namespace wiimote_tracker::motion::test
