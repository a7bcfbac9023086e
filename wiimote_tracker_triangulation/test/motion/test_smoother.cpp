#include "motion/filter_scene.h"

#include "geometry/accuracy.h"
#include "motion/motion_filter.h"
#include "motion/smoother.h"
#include "motion/textbook_imm.h"
#include "tracking/paths.h"
#include "wiimote_tracker_triangulation/geometry/linear_algebra.h"

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include <cmath>
#include <vector>

namespace wiimote_tracker::motion {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using geometry::Camera;
using geometry::test::Random;
using test::kPixelStddev;
using test::kStep;
using tracking::test::Path;

/// What four cameras in turn see of an LED.
std::vector<Observation> watch(const std::vector<Camera>& cameras,
                               const Path& path,
                               int count,
                               Random& random) {
  std::vector<Observation> result;
  for (int i = 0; i < count; ++i) {
    const Camera& camera = cameras[i % 4];
    result.push_back({kStep * i,
                      &camera,
                      test::noisyPixel(camera, path(kStep * i), random),
                      {kPixelStddev, 0.0}});
  }
  return result;
}

std::vector<Place> placesOn(const Path& path, const std::vector<Observation>& observations) {
  std::vector<Place> result;
  for (std::size_t i = 0; i < observations.size(); i += 3) {
    const double time = observations[i].time;
    result.push_back({time, path(time) + Vector3d(0.02, -0.01, 0.03)});
  }
  return result;
}

double squaredDistance(const Vector3d& error, const KinematicState& state) {
  return geometry::squaredMahalanobis(error, state.positionCovariance());
}

/// Every state given all observations at once, without recursion: the states of a Singer model are
/// jointly normal, so the observations condition them in one step. Linearised at its own result.
std::vector<KinematicState> batch(double stddev,
                                  double time,
                                  double speed,
                                  const Vector3d& start,
                                  const std::vector<Observation>& observations) {
  const auto n = static_cast<Eigen::Index>(observations.size());
  const test::Transition step = test::singerTransition(stddev, time, kStep).inThreeAxes();
  MatrixXd joint(9 * n, 9 * n);
  VectorXd prior(9);
  prior << Vector3d::Constant(0.25), Vector3d::Constant(speed * speed),
      Vector3d::Constant(stddev * stddev);
  MatrixXd covariance = prior.asDiagonal();
  for (Eigen::Index i = 0; i < n; ++i) {
    MatrixXd block = covariance;
    for (Eigen::Index j = i; j < n; ++j) {
      joint.block<9, 9>(9 * i, 9 * j) = block;
      joint.block<9, 9>(9 * j, 9 * i) = block.transpose();
      block = (block * step.F.transpose()).eval();
    }
    covariance = (step.F * covariance * step.F.transpose() + step.Q).eval();
  }
  VectorXd mean = VectorXd::Zero(9 * n);
  for (Eigen::Index i = 0; i < n; ++i)
    mean.segment<3>(9 * i) = start;
  VectorXd posterior = mean;
  MatrixXd posterior_covariance;
  for (int iteration = 0; iteration < 4; ++iteration) {
    MatrixXd H = MatrixXd::Zero(2 * n, 9 * n);
    VectorXd z(2 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Vector3d at = posterior.segment<3>(9 * i);
      Eigen::Matrix<double, 2, 3> jacobian;
      const auto pixel = observations[i].camera->project(at, &jacobian);
      H.block<2, 3>(2 * i, 9 * i) = jacobian;
      z.segment<2>(2 * i) = observations[i].pixel - *pixel + jacobian * at;
    }
    const MatrixXd cross = joint * H.transpose();
    const Eigen::LLT<MatrixXd> innovation(H * cross + kPixelStddev * kPixelStddev *
                                                          MatrixXd::Identity(2 * n, 2 * n));
    posterior = mean + cross * innovation.solve(z - H * mean);
    posterior_covariance = joint - cross * innovation.solve(cross.transpose());
  }
  std::vector<KinematicState> result(observations.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    result[i].mean = posterior.segment<9>(9 * i);
    result[i].covariance = posterior_covariance.block<9, 9>(9 * i, 9 * i);
  }
  return result;
}

TEST(Smoother, WithOneModeIsTheBatchSolution) {
  constexpr double kStddev = 2.0, kTime = 0.2, kSpeed = 30.0;
  MotionOptions options;
  options.moving.fill({kStddev, kTime});
  options.sudden_random_walk = options.stop_rate = options.rise_rate = options.settle_rate = 0.0;
  options.initial_speed = kSpeed;
  const std::vector<Camera> cameras = test::ring();
  Random random(21);
  const Path path = tracking::test::shaken(random, Vector3d::Zero(), 0.5, 3.0);
  const std::vector<Observation> observations = watch(cameras, path, 80, random);
  std::vector<Place> places;
  for (const Observation& observation : observations)
    places.push_back({observation.time, path(0.0) + Vector3d(0.02, -0.01, 0.03)});
  const std::vector<KinematicState> smoothed = smooth(options, observations, places);
  const std::vector<KinematicState> truth =
      batch(kStddev, kTime, kSpeed, places.front().position, observations);
  ASSERT_EQ(truth.size(), smoothed.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    // They differ in the points of linearisation.
    const Vector3d difference = smoothed[i].position() - truth[i].position();
    EXPECT_LT(squaredDistance(difference, truth[i]), 0.02 * 0.02) << i;
    EXPECT_LT(test::relative(smoothed[i].covariance, truth[i].covariance), 0.02) << i;
    EXPECT_LT((smoothed[i].velocity() - truth[i].velocity()).norm(),
              0.02 * std::sqrt(truth[i].velocityCovariance().trace()))
        << i;
  }
}

TEST(ExtensiveSmoother, IsBetterThanTheFilterAndConsistent) {
  struct Motion {
    double speed, acceleration;
  };
  const MotionOptions options;
  const std::vector<Camera> cameras = test::ring();
  for (const Motion& motion : {Motion{0.2, 0.5}, Motion{1.0, 6.0}, Motion{3.0, 38.0}}) {
    Random random(22);
    double filtered = 0.0;
    geometry::test::Accuracy smoothed;
    for (int run = 0; run < 8; ++run) {
      const Path path =
          tracking::test::shaken(random, Vector3d::Zero(), motion.speed, motion.acceleration);
      const std::vector<Observation> observations = watch(cameras, path, 1200, random);
      const std::vector<Place> places = placesOn(path, observations);
      const std::vector<KinematicState> states = smooth(options, observations, places);
      MotionFilter filter(options, 0.0, places.front().position,
                          0.04 * Eigen::Matrix3d::Identity());
      std::size_t next = 0;
      for (std::size_t i = 0; i < places.size(); ++i) {
        for (; next <= 3 * i; ++next)
          ASSERT_TRUE(test::takeIn(&filter, observations[next].time, *observations[next].camera,
                                   observations[next].pixel));
        if (i < 60 || i + 60 > places.size())
          continue;
        const Vector3d truth = path(places[i].time);
        filtered += (filter.position() - truth).squaredNorm();
        smoothed.add(states[i].position() - truth, states[i].positionCovariance());
      }
    }
    EXPECT_LT(std::sqrt(smoothed.squares / filtered), 0.6) << motion.speed;
    EXPECT_GT(smoothed.shareInside(), 0.93) << motion.speed;
    EXPECT_NEAR(3.0, smoothed.nees(), 1.0) << motion.speed;
  }
}

TEST(Smoother, BridgesAGap) {
  const std::vector<Camera> cameras = test::ring();
  Random random(23);
  const Path path = tracking::test::circle(Vector3d::Zero(), 0.5, 1.0);
  std::vector<Observation> observations = watch(cameras, path, 800, random);
  const std::vector<Place> places = placesOn(path, observations);
  observations.erase(observations.begin() + 400, observations.begin() + 480);  // 0.2 s
  const std::vector<KinematicState> states = smooth(MotionOptions(), observations, places);
  for (std::size_t i = 60; i + 60 < places.size(); ++i) {
    const Vector3d error = states[i].position() - path(places[i].time);
    EXPECT_LT(error.norm(), 0.015) << places[i].time;
    EXPECT_LT(squaredDistance(error, states[i]), 21.1) << places[i].time;  // 99.99 %
  }
}

TEST(Smoother, StartsAnewWhereTheLedWasFoundElsewhere) {
  const std::vector<Camera> cameras = test::ring();
  Random random(24);
  const auto path = [](double time) { return Vector3d(time < 1.0 ? -0.4 : 0.4, 0.1, 0.2); };
  const std::vector<Observation> observations = watch(cameras, path, 800, random);
  const std::vector<Place> places = placesOn(path, observations);
  const std::vector<KinematicState> states = smooth(MotionOptions(), observations, places);
  for (std::size_t i = 0; i < places.size(); ++i)
    EXPECT_LT((states[i].position() - path(places[i].time)).norm(), 0.01) << places[i].time;
}

TEST(Smoother, IsConsistentWhereOneCameraSawTheLedLast) {
  const std::vector<Camera> cameras = test::ring();
  constexpr double kInterval = 0.033, kAlone = 1.0, kNoise = 0.08;
  Random random(25);
  geometry::test::Accuracy alone;
  for (int run = 0; run < 20; ++run) {
    const int last = 64 + 2 * run;  // image
    const Path path =
        tracking::test::shaken(random, Vector3d::Zero(), 1.0 + run % 3, 10.0 + run % 30);
    std::vector<Observation> observations;
    std::vector<Place> places;
    for (int i = 0; i <= last; ++i) {
      const double time = 0.5 * kInterval * i;
      if (time > kAlone && i % 2 == 1)
        continue;
      const Camera& camera = cameras[i % 2];
      const double u = random.gaussian();
      const Eigen::Vector2d noise(u, random.gaussian());
      observations.push_back(
          {time, &camera, *camera.project(path(time)) + kNoise * noise, {kNoise, 0.0005}});
      places.push_back({time, path(time) + Vector3d(0.02, -0.01, 0.03)});
    }
    const std::vector<KinematicState> states = smooth(MotionOptions(), observations, places);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Vector3d error = states[i].position() - path(places[i].time);
      if (places[i].time < kAlone) {
        EXPECT_LT(squaredDistance(error, states[i]), 21.1) << run << " " << places[i].time;
      } else {
        alone.add(error, states[i].positionCovariance());
      }
    }
  }
  EXPECT_GT(alone.count, 150);
  EXPECT_GT(alone.shareInside(), 0.9);
}

TEST(Smoother, StartsAnewWithinWhatOneCameraSaw) {
  const std::vector<Camera> cameras = test::ring();
  constexpr double kInterval = 0.033, kAlone = 1.0, kTogetherAgain = 1.6, kNoise = 0.08;
  Random random(26);
  for (int run = 0; run < 20; ++run) {
    const int wrong = 64 + 2 * (run % 10);  // image with another light
    const Path path =
        tracking::test::shaken(random, Vector3d::Zero(), 1.0 + run % 3, 10.0 + run % 30);
    std::vector<Observation> observations;
    std::vector<Place> places;
    for (int i = 0; i <= 160; ++i) {
      const double time = 0.5 * kInterval * i;
      if (time > kAlone && time < kTogetherAgain && i % 2 == 1)
        continue;
      const Camera& camera = cameras[i % 2];
      Eigen::Vector2d pixel = *camera.project(path(time));
      pixel += kNoise * Eigen::Vector2d(random.gaussian(), random.gaussian());
      if (i == wrong)
        pixel += Eigen::Vector2d(200.0, 100.0);
      observations.push_back({time, &camera, pixel, {kNoise, 0.0005}});
      places.push_back({time, path(time) + Vector3d(0.02, -0.01, 0.03)});
    }
    const std::vector<KinematicState> states = smooth(MotionOptions(), observations, places);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Vector3d error = states[i].position() - path(places[i].time);
      EXPECT_LT(squaredDistance(error, states[i]), 21.1) << run << " " << places[i].time;
    }
  }
}

TEST(Smoother, TakesPlacesWithoutObservations) {
  EXPECT_TRUE(smooth(MotionOptions(), {}, {}).empty());
  const auto states = smooth(MotionOptions(), {}, {{1.0, {0.1, 0.2, 0.3}}});
  ASSERT_EQ(1u, states.size());
  EXPECT_LT((states[0].position() - Vector3d(0.1, 0.2, 0.3)).norm(), 1e-9);
}

}  // namespace
}  // namespace wiimote_tracker::motion
