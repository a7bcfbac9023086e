// Velocity and angular velocity of a followed body, compared with the posterior Cramer-Rao bound.
#include "body/body_scene.h"
#include "body/body_tracker.h"
#include "geometry/gaussian.h"
#include "wiimote_tracker_triangulation/geometry/linear_algebra.h"

#include <gtest/gtest.h>
#include <Eigen/LU>

#include <cmath>
#include <optional>
#include <string>

namespace wiimote_tracker::body {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using geometry::test::Random;
using test::fourLeds;
using tracking::test::paperRig;
using Vector12 = Eigen::Matrix<double, 12, 1>;

constexpr double kInterval = 0.0025;  // four cameras, each 100 times a second [s]

/// Pose and velocities, in the world.
struct BodyState {
  Isometry3d pose = Isometry3d::Identity();
  Vector3d velocity = Vector3d::Zero();
  Vector3d turning = Vector3d::Zero();
};

/// Errors in the order of BodyEstimate::covariance.
BodyState plus(const BodyState& state, const Vector12& step) {
  BodyState result = state;
  result.pose.translation() += step.head<3>();
  const Vector3d turn = step.segment<3>(3);
  if (turn.norm() > 0.0)
    result.pose.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * state.pose.linear();
  result.velocity += step.segment<3>(6);
  result.turning += step.tail<3>();
  return result;
}

Vector12 minus(const BodyState& a, const BodyState& b) {
  Vector12 difference;
  difference << a.pose.translation() - b.pose.translation(), test::rotationError(b.pose, a.pose),
      a.velocity - b.velocity, a.turning - b.turning;
  return difference;
}

/// Without noise.
BodyState moved(const BodyState& state, double dt) {
  Vector12 step = Vector12::Zero();
  step.head<3>() = dt * state.velocity;
  step.segment<3>(3) = dt * state.turning;
  return plus(state, step);
}

/// Of white acceleration and angular acceleration over an interval.
MotionCovariance motionNoise(const PoseMode& mode, double dt) {
  MotionCovariance noise = MotionCovariance::Zero();
  for (int i = 0; i < 6; ++i) {
    const double density = i < 3 ? mode.acceleration_density : mode.angular_acceleration_density;
    const double q = density * density;
    noise(i, i) = q * dt * dt * dt / 3.0;
    noise(i, i + 6) = noise(i + 6, i) = q * dt * dt / 2.0;
    noise(i + 6, i + 6) = q * dt;
  }
  return noise;
}

template <typename Function>
MotionCovariance differences(const Function& function) {
  constexpr double kStep = 1e-5;
  MotionCovariance result;
  for (int k = 0; k < 12; ++k)
    result.col(k) = (function(kStep * Vector12::Unit(k)) - function(-kStep * Vector12::Unit(k))) /
                    (2.0 * kStep);
  return result;
}

/// Tichavsky, Muravchik and Nehorai, "Posterior Cramer-Rao bounds for discrete-time nonlinear
/// filtering", 1998, along the true motion; derivatives by differences.
class PosteriorBound {
 public:
  PosteriorBound(const PoseMode& mode, const PoseFilterOptions& start, double pixel_stddev)
      : mode_(mode), pixel_stddev_(pixel_stddev) {
    covariance_.diagonal().segment<6>(0).setConstant(1.0);
    covariance_.diagonal().segment<3>(6).setConstant(std::pow(start.initial_speed, 2));
    covariance_.diagonal().segment<3>(9).setConstant(std::pow(start.initial_angular_speed, 2));
  }

  void predict(const BodyState& before) {
    const BodyState after = moved(before, kInterval);
    const MotionCovariance transition = differences(
        [&](const Vector12& d) { return minus(moved(plus(before, d), kInterval), after); });
    covariance_ = transition * covariance_ * transition.transpose() + motionNoise(mode_, kInterval);
  }

  /// All LEDs of the body that the camera sees.
  void see(const geometry::Camera& camera, const Constellation& body, const BodyState& state) {
    constexpr double kStep = 1e-5;
    MotionCovariance information = covariance_.inverse();
    for (const Vector3d& led : body.leds) {
      if (!camera.sees(state.pose * led))
        continue;
      Eigen::Matrix<double, 2, 6> jacobian;
      for (int k = 0; k < 6; ++k)
        jacobian.col(k) = (*camera.project(plus(state, kStep * Vector12::Unit(k)).pose * led) -
                           *camera.project(plus(state, -kStep * Vector12::Unit(k)).pose * led)) /
                          (2.0 * kStep);
      information.topLeftCorner<6, 6>() +=
          jacobian.transpose() * jacobian / (pixel_stddev_ * pixel_stddev_);
    }
    covariance_ = information.inverse();
  }

  const MotionCovariance& covariance() const { return covariance_; }

 private:
  PoseMode mode_;
  double pixel_stddev_;
  MotionCovariance covariance_ = MotionCovariance::Zero();
};

/// Motion drawn from a mode.
class BodyRates : public testing::TestWithParam<PoseMode> {};

TEST_P(BodyRates, AreAtTheBoundOfTheSameScene) {
  const geometry::Rig rig = paperRig();
  const Constellation body = fourLeds();
  const BodyTrackerOptions options;
  const MotionCovariance noise_root = geometry::test::rootOf(motionNoise(GetParam(), kInterval));
  Random random(71);
  const auto gaussians = [&] {
    Vector12 z;
    for (int i = 0; i < 12; ++i)
      z[i] = random.gaussian();
    return z;
  };
  Eigen::Vector4d squares = Eigen::Vector4d::Zero();  // position, rotation, velocity, turning
  Eigen::Vector4d bounds = Eigen::Vector4d::Zero();
  double nees = 0.0, judged = 0.0;
  for (int run = 0; run < 40; ++run) {
    BodyTracker tracker(rig, {body}, options);
    PosteriorBound bound(GetParam(), options.motion, options.pixel_stddev);
    BodyState truth;
    truth.pose = test::randomPose(random, {1.25, 1.25, 1.1});
    truth.velocity = 0.3 * gaussians().head<3>();
    truth.turning = 2.0 * gaussians().head<3>();
    for (int i = 0; i < 320; ++i) {
      bound.predict(truth);
      truth = plus(moved(truth, kInterval), noise_root * gaussians());
      const std::size_t c = static_cast<std::size_t>(i) % 4;
      const geometry::Camera& camera = rig.cameras[c].camera;
      bound.see(camera, body, truth);
      std::vector<Eigen::Vector2d> pixels;
      for (const Vector3d& led : body.leds) {
        if (!camera.sees(truth.pose * led))
          continue;
        const double du = options.pixel_stddev * random.gaussian();
        pixels.push_back(*camera.project(truth.pose * led) +
                         Eigen::Vector2d(du, options.pixel_stddev * random.gaussian()));
      }
      test::take(c, 1000.0 + kInterval * i, pixels, &tracker);
      if (i < 160 || i % 16 != 0)
        continue;
      const std::optional<BodyEstimate>& found = tracker.bodies()[0];
      ASSERT_TRUE(found) << "run " << run;
      const Vector12 error =
          minus({found->world_from_body, found->velocity, found->angular_velocity}, truth);
      for (Eigen::Index k = 0; k < 4; ++k) {
        squares[k] += error.segment<3>(3 * k).squaredNorm();
        bounds[k] += bound.covariance().diagonal().segment<3>(3 * k).sum();
      }
      nees += geometry::squaredMahalanobis(error, found->covariance) / 12.0;
      judged += 1.0;
    }
  }
  const Eigen::Vector4d ratio = (squares.array() / bounds.array()).sqrt();
  const char* const names[] = {"position", "rotation", "velocity", "angular_velocity"};
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(1.0, ratio[k], 0.1) << names[k];
    RecordProperty(std::string(names[k]) + "_ratio", std::to_string(ratio[k]));
    RecordProperty(std::string(names[k]) + "_rms", std::to_string(std::sqrt(squares[k] / judged)));
  }
  nees /= judged;
  EXPECT_GT(nees, 0.8);
  EXPECT_LT(nees, 1.2);
  RecordProperty("nees", std::to_string(nees));
}

INSTANTIATE_TEST_SUITE_P(CalmAndAgile,
                         BodyRates,
                         testing::Values(PoseFilterOptions().modes[kCalm],
                                         PoseFilterOptions().modes[kAgile]));

TEST(TurningBody, HasTheAngularVelocityOfTheMotion) {
  // A steady turn: mean errors are far below the turn itself.
  tracking::test::SceneOptions options;
  options.pixel_noise = 0.5;
  test::FollowedBody follow(paperRig(), fourLeds(), test::tumbling, options, 72);
  Vector3d mean = Vector3d::Zero();
  int count = 0;
  while (follow.time() < 1004.0) {
    follow.step();
    if (follow.time() < 1001.0 || !follow.estimate())
      continue;
    mean += follow.estimate()->angular_velocity;
    ++count;
  }
  mean /= count;
  EXPECT_LT((mean - 2.0 * M_PI * Vector3d(0.48, 0.6, 0.64)).norm(), 0.05);  // [rad/s]
}

}  // namespace
}  // namespace wiimote_tracker::body
