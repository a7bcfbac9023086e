#include "geometry/accuracy.h"
#include "motion/filter_scene.h"
#include "motion/known_mode.h"
#include "motion/textbook_imm.h"
#include "tracking/paths.h"
#include "wiimote_tracker_triangulation/geometry/linear_algebra.h"

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <array>

namespace wiimote_tracker::motion::test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::Camera;
using geometry::test::Random;

TEST(MotionFilter, IsTheTextbooksFilter) {
  const std::vector<Camera> cameras = ring();
  MotionOptions options;
  options.settle_rate = 0.5;  // so that every change counts
  Random random(1);
  const Matrix3d covariance = Vector3d(1e-6, 2e-6, 3e-6).asDiagonal();
  MotionFilter filter(options, 0.0, variedPath(0.0), covariance);
  TextbookImm textbook(options, 0.0, variedPath(0.0), covariance);
  double stopped = 0.0, changed = 0.0;
  for (int i = 1; i < 800; ++i) {
    // Cameras drop out for a while: steps of different length.
    if (i % 200 > 50 && i % 200 < 70 && i % 7 != 0)
      continue;
    const double time = kStep * i;
    const Camera& camera = cameras[i % 4];
    const Vector2d pixel = noisyPixel(camera, variedPath(time), random);
    filter.predict(time);
    textbook.predict(time);
    if (time - stopped >= 0.002) {
      textbook.stop(time - stopped);
      stopped = time;
    }
    if (time - changed >= 0.01) {
      textbook.change(time - changed);
      changed = time;
    }
    const auto prediction = filter.predictPixel(camera, {kPixelStddev, 0.0});
    ASSERT_TRUE(prediction);
    EXPECT_NEAR(std::log(textbook.density(camera, pixel, kPixelStddev)),
                prediction->logLikelihood(pixel), 1e-4);
    ASSERT_TRUE(filter.update(camera, *prediction, pixel));
    textbook.update(camera, pixel, kPixelStddev);

    ASSERT_LT((textbook.mean().head<3>() - filter.position()).norm(), 1e-8) << time;
    ASSERT_LT((textbook.mean().segment<3>(3) - filter.velocity()).norm(), 1e-5) << time;
    ASSERT_NEAR(textbook.models()[0].probability + textbook.models()[1].probability,
                restProbability(filter), 1e-4)
        << time;
    ASSERT_LT(relative(filter.positionCovariance(), textbook.covariance().topLeftCorner<3, 3>()),
              1e-3);
    ASSERT_LT(relative(filter.velocityCovariance(), textbook.covariance().block<3, 3>(3, 3)), 1e-3);
  }
}

/// Errors beside a bound.
struct BoundedErrors : geometry::test::Accuracy {
  double bounds = 0.0;  // of the squared errors, summed [m^2]

  void take(const MotionFilter& filter, const Vector3d& truth, double squared_bound) {
    add(filter.position() - truth, filter.positionCovariance());
    bounds += squared_bound;
  }
  double squaredRatio() const { return squares / bounds; }
};

TEST(MotionFilter, ReachesThePosteriorCramerRaoBoundOfItsOwnModel) {
  constexpr int kRuns = 60;
  constexpr double kStddev = 2.0, kTime = 0.2;
  MotionOptions options;  // a single mode
  options.moving.fill({kStddev, kTime});
  options.sudden_random_walk = options.stop_rate = 0.0;
  options.initial_speed = 0.3;
  const Matrix3d covariance = 4e-6 * Matrix3d::Identity();
  const std::vector<Camera> cameras = ring();
  Random random(5);
  BoundedErrors all;
  std::vector<double> nees_of_runs, ratio_of_runs;
  for (int run = 0; run < kRuns; ++run) {
    SingerTruth truth(kStddev, kTime, kStep);
    const Vector3d position = random.inBox(0.3);
    Vector3d velocity, error;
    for (int i = 0; i < 3; ++i) {
      velocity[i] = options.initial_speed * random.gaussian();
      error[i] = 2e-3 * random.gaussian();
    }
    truth.place(position, velocity);
    truth.startMoving(random);
    MotionFilter filter(options, 0.0, position + error, covariance);
    KnownModeBound bound(kStddev, kTime, kStep, covariance, options.initial_speed);
    BoundedErrors one;
    for (int i = 1; i <= 320; ++i) {
      truth.step(random);
      bound.step();
      const Camera& camera = cameras[i % 4];
      ASSERT_TRUE(takeIn(&filter, kStep * i, camera, noisyPixel(camera, truth.position(), random)));
      bound.observe(camera, truth.position(), kPixelStddev);
      one.take(filter, truth.position(), bound.squaredError());
      all.take(filter, truth.position(), bound.squaredError());
    }
    nees_of_runs.push_back(one.nees());
    ratio_of_runs.push_back(one.squaredRatio());
  }
  // Within four standard errors, estimated from the runs, which are independent.
  const auto standardError = [](const std::vector<double>& values) {
    double sum = 0.0, squares = 0.0;
    for (const double v : values) {
      sum += v;
      squares += v * v;
    }
    const double n = static_cast<double>(values.size());
    return std::sqrt((squares / n - sum * sum / (n * n)) / (n - 1.0));
  };
  EXPECT_NEAR(3.0, all.nees(), 4.0 * standardError(nees_of_runs));
  EXPECT_NEAR(1.0, all.squaredRatio(), 4.0 * standardError(ratio_of_runs));
  EXPECT_LT(standardError(nees_of_runs), 0.15);
}

TEST(MotionFilter, IsQuietWhenStillAndKeepsUpWithJumps) {
  constexpr int kRuns = 12;
  constexpr double kAcceleration = 2.0, kTime = 0.2;  // of none of the filter's modes
  const std::vector<Camera> cameras = ring();
  const Matrix3d covariance = 4e-6 * Matrix3d::Identity();
  Random random(6);
  BoundedErrors all, still;
  for (int run = 0; run < kRuns; ++run) {
    SingerTruth truth(kAcceleration, kTime, kStep);
    truth.place(random.inBox(0.2), Vector3d::Zero());
    const Vector3d start = truth.position() + random.inBox(2e-3);
    MotionFilter filter(kDefault, 0.0, start, covariance);
    KnownModeBound bound(kAcceleration, kTime, kStep, covariance, 0.0);
    bound.stop();
    for (int i = 1; i <= 2800; ++i) {
      if (i % 1400 == 800) {  // 2 s still, 1.5 s moving
        truth.startMoving(random);
        bound.startMoving();
      } else if (i % 1400 == 0) {
        truth.stop();
        bound.stop();
      }
      truth.step(random);
      bound.step();
      const Camera& camera = cameras[i % 4];
      const auto pixel = camera.project(truth.position());
      ASSERT_TRUE(pixel);
      filter.predict(kStep * i);
      const auto prediction = filter.predictPixel(camera, {kPixelStddev, 0.0});
      ASSERT_TRUE(prediction);
      const Vector2d measured = noisyPixel(camera, truth.position(), random);
      // No gate needs to be wider than this, except after a stop at full speed.
      EXPECT_LT(prediction->squaredDistance(measured), i % 1400 < 4 ? 100.0 : 36.0);
      ASSERT_TRUE(filter.update(camera, *prediction, measured));
      bound.observe(camera, truth.position(), kPixelStddev);
      all.take(filter, truth.position(), bound.squaredError());
      if (!truth.moves())
        still.take(filter, truth.position(), bound.squaredError());
    }
  }
  EXPECT_LT(std::sqrt(all.squaredRatio()), 1.10);
  EXPECT_LT(std::sqrt(still.squaredRatio()), 1.4);
}

TEST(MotionFilter, FollowsASuddenStartAtThreeMetresPerSecond) {
  const std::vector<Camera> cameras = ring();
  Random random(7);
  MotionFilter filter(kDefault, 0.0, Vector3d(-0.5, 0.0, 0.0), 1e-6 * Matrix3d::Identity());
  for (int i = 1; i <= 1000; ++i) {
    const double time = kStep * i;
    const Vector3d truth(-0.5 + 3.0 * std::max(0.0, time - 2.2), 0.0, 0.0);
    const Camera& camera = cameras[i % 4];
    ASSERT_TRUE(takeIn(&filter, time, camera, noisyPixel(camera, truth, random)));
    const Vector3d error = filter.position() - truth;
    EXPECT_LT(error.norm(), 0.06) << time;
    if (time > 2.3) {
      EXPECT_LT(error.norm(), 0.01) << time;
    }
  }
  EXPECT_LT((filter.velocity() - Vector3d(3.0, 0.0, 0.0)).norm(), 0.3);
}

TEST(MotionFilter, KeepsUpWithHardMotion) {
  constexpr double kSpeed = 3.0, kAcceleration = 38.0;
  MotionOptions single;  // the best single mode for this motion
  single.moving.fill({22.0, 0.16});
  single.sudden_random_walk = single.stop_rate = 0.0;
  const std::vector<Camera> cameras = ring();
  Random random(16);
  geometry::test::Accuracy accuracy;
  double best = 0.0;
  for (int run = 0; run < 4; ++run) {
    const auto path = tracking::test::shaken(random, Vector3d::Zero(), kSpeed, kAcceleration);
    MotionFilter filter(kDefault, 0.0, path(0.0), 4e-6 * Matrix3d::Identity());
    MotionFilter ideal(single, 0.0, path(0.0), 4e-6 * Matrix3d::Identity());
    for (int i = 1; i <= 1200; ++i) {
      const Vector3d truth = path(kStep * i);
      const Vector2d pixel = noisyPixel(cameras[i % 4], truth, random);
      ASSERT_TRUE(takeIn(&filter, kStep * i, cameras[i % 4], pixel));
      ASSERT_TRUE(takeIn(&ideal, kStep * i, cameras[i % 4], pixel));
      if (i <= 200)
        continue;
      accuracy.add(filter.position() - truth, filter.positionCovariance());
      best += (ideal.position() - truth).squaredNorm();
    }
  }
  EXPECT_LT(std::sqrt(accuracy.squares / best), 1.05);
  EXPECT_NEAR(0.95, accuracy.shareInside(), 0.02);
}

TEST(MotionFilter, GrowsUncertainInAGapAndFindsBack) {
  const std::vector<Camera> cameras = ring();
  Random random(8);
  for (const double gap : {0.1, 0.5, 3.0, 1000.0}) {
    MotionFilter filter(kDefault, 0.0, variedPath(0.0), 1e-6 * Matrix3d::Identity());
    for (int i = 1; i < 400; ++i)
      ASSERT_TRUE(takeIn(&filter, kStep * i, cameras[i % 4],
                         noisyPixel(cameras[i % 4], variedPath(kStep * i), random)));
    double before = filter.positionCovariance().trace();
    const double end = filter.time() + gap;
    for (double time = filter.time() + 0.02 * gap; time < end; time += 0.05 * gap) {
      filter.predict(time);
      const double now = filter.positionCovariance().trace();
      EXPECT_GT(now, before);
      before = now;
    }
    filter.predict(end);
    ASSERT_TRUE(filter.position().allFinite());
    ASSERT_EQ(Eigen::Success, filter.positionCovariance().llt().info());
    if (gap > 10.0)
      continue;  // its position is unknown
    const Vector3d truth = variedPath(end);
    const Vector3d error = filter.position() - truth;
    EXPECT_LT(geometry::squaredMahalanobis(error, filter.positionCovariance()), 16.3);  // 99.9 %
    for (int i = 0; i < 40; ++i)
      takeIn(&filter, end + kStep * i, cameras[i % 4], noisyPixel(cameras[i % 4], truth, random));
    EXPECT_LT((filter.position() - truth).norm(), 0.01) << gap;
  }
}

/// Straight towards a camera for odd numbers, away from it for even ones.
tracking::test::Path alongARay(const Camera& camera, int number) {
  const Vector3d velocity = (number % 2 == 0 ? 1.0 : -1.0) * camera.center().normalized();
  return [velocity](double time) -> Vector3d { return (1.0 - time) * velocity; };
}

TEST(MotionFilter, OneCameraAloneLeavesTheDistanceUncertain) {
  constexpr int kRuns = 100;
  struct Motion {
    double speed, acceleration;  // RMS [m/s], [m/s^2]; none: uniform
  };
  const std::vector<Camera> cameras = ring();
  const std::array<double, 3> alone{0.2, 0.4, 0.6};  // [s]
  for (const Motion& motion : {Motion{1.0, 0.0}, Motion{0.5, 2.0}, Motion{1.0, 6.0},
                               Motion{2.0, 17.0}, Motion{3.0, 38.0}}) {
    Random random(14);
    std::array<int, 3> inside{};
    for (int run = 0; run < kRuns; ++run) {
      const Camera& last = cameras[run % 4];
      const tracking::test::Path path =
          motion.acceleration > 0.0
              ? tracking::test::shaken(random, Vector3d::Zero(), motion.speed, motion.acceleration)
              : alongARay(last, run / 4);
      MotionFilter filter(kDefault, 0.0, path(0.0), 4e-6 * Matrix3d::Identity());
      std::size_t next = 0;
      for (int i = 1; next < alone.size(); ++i) {
        const double time = kStep * i;
        if (time > 1.0 && i % 4 != run % 4)
          continue;
        const Camera& camera = cameras[i % 4];
        ASSERT_TRUE(takeIn(&filter, time, camera, noisyPixel(camera, path(time), random)));
        if (time > 1.0 + alone[next]) {
          const Vector3d error = filter.position() - path(time);
          inside[next++] +=
              geometry::squaredMahalanobis(error, filter.positionCovariance()) < 7.815;
        }
      }
    }
    // At least 90 %, less four standard deviations for this number of runs.
    const double least = 0.9 * kRuns - 4.0 * std::sqrt(0.9 * 0.1 * kRuns);
    for (std::size_t i = 0; i < alone.size(); ++i)
      EXPECT_GT(inside[i], least) << motion.speed << " " << motion.acceleration << " " << alone[i];
  }
}

TEST(MotionFilter, IteratesFromAPoorStart) {
  // Depth almost unknown: a single linearisation would miss by several standard deviations.
  const std::vector<Camera> cameras = ring();
  const Vector3d truth(0.1, 0.2, 0.3);
  const Vector3d away = (truth - cameras[0].center()).normalized();
  Matrix3d covariance = 1e-6 * Matrix3d::Identity() + 0.09 * away * away.transpose();
  MotionOptions options;
  options.initial_speed = 1e-3;
  MotionFilter filter(options, 0.0, truth + 0.4 * away, covariance);
  for (const int i : {1, 2, 3}) {
    const auto prediction = filter.predictPixel(cameras[i], {kPixelStddev, 0.0});
    ASSERT_TRUE(prediction);
    ASSERT_TRUE(filter.update(cameras[i], *prediction, *cameras[i].project(truth)));
  }
  const Vector3d error = filter.position() - truth;
  EXPECT_LT(geometry::squaredMahalanobis(error, filter.positionCovariance()), 0.05);
}

}  // namespace
}  // namespace wiimote_tracker::motion::test
