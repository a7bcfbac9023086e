// A body with an IMU. The truth is a formula; what the IMU measures are its differences.
#include "body/body_scene.h"
#include "body/body_tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::body {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using geometry::test::Random;

constexpr double kStart = 1000.0;         // [s]
constexpr double kSampleInterval = 0.01;  // [s]
constexpr double kHidden = 0.5;           // [s]
constexpr double kPeriod = 2.0;           // of being hidden, after kLearning [s]
constexpr double kLearning = 4.0;         // [s]
constexpr double kNever = 1e9;            // [s]

/// Up to 1.3 m/s and 2.4 rad/s.
Isometry3d carried(double time) {
  const double t = time - kStart;
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = Vector3d(1.25 + 0.45 * std::sin(2.1 * t), 1.25 + 0.45 * std::cos(1.7 * t),
                                1.1 + 0.2 * std::sin(2.9 * t));
  pose.linear() = (Eigen::AngleAxisd(1.1 * std::sin(1.3 * t), Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(0.6 * std::sin(2.3 * t + 0.5), Vector3d::UnitX()))
                      .toRotationMatrix();
  return pose;
}

double hiddenSince(double time) {
  const double t = time - kStart - kLearning;
  return t < 0.0 ? -kNever : std::fmod(t, kPeriod) - (kPeriod - kHidden);
}

Constellation withImu() {
  Constellation body = test::fourLeds();
  body.imu = ImuMount{"imu", Isometry3d::Identity()};
  body.imu->body_from_imu.translation() = Vector3d(0.03, -0.02, 0.05);
  return body;
}

/// Samples at a steady rate, with white noise and biases.
class Imu {
 public:
  explicit Imu(unsigned seed) : random_(seed) {
    gyro_bias_ = test::noise(random_, 0.03);
    force_bias_ = test::noise(random_, 0.2);
  }

  InertialSample next() {
    constexpr double kStep = 1e-3;  // [s]
    const double t = time_;
    time_ += kSampleInterval;
    const Vector3d place = withImu().imu->body_from_imu.translation();
    const auto at = [&](double when) { return Vector3d(carried(when) * place); };
    const Vector3d acceleration = (at(t + kStep) - 2.0 * at(t) + at(t - kStep)) / (kStep * kStep);
    const Vector3d rate =
        test::rotationError(carried(t - kStep), carried(t + kStep)) / (2.0 * kStep);
    const Eigen::Matrix3d body_from_world = carried(t).linear().transpose();
    const InertialOptions options;
    const double root = std::sqrt(1.0 / kSampleInterval);
    return {t,
            body_from_world * rate + gyro_bias_ + test::noise(random_, options.gyro_density * root),
            body_from_world * (acceleration + Vector3d(0.0, 0.0, 9.80665)) + force_bias_ +
                test::noise(random_, options.accelerometer_density * root)};
  }

  double time() const { return time_; }  ///< Of the next sample [s].

 private:
  Random random_;
  double time_ = kStart - 0.1;
  Vector3d gyro_bias_, force_bias_;
};

using Change = std::function<InertialSample(InertialSample)>;

/// A carried body that is hidden now and then, image by image.
class Carried {
 public:
  /// @param delay of the samples after the exposures [s]. @param end of the samples [s]
  /// @param change of each sample: what is wrong with the IMU
  explicit Carried(
      unsigned seed,
      double delay = 0.0,
      double end = kNever,
      const Change& change = [](const InertialSample& sample) { return sample; })
      : scene_(tracking::test::paperRig(), test::pathsOf(withImu(), carried), options(), seed),
        tracker_(tracking::test::paperRig(), {withImu()}, trackerOptions()),
        imu_(seed),
        change_(change),
        delay_(delay),
        end_(end) {}

  void step() {
    const tracking::test::SceneImage& image = scene_.next();
    while (imu_.time() + delay_ < image.image.arrival && imu_.time() < end_)
      tracker_.addInertial(0, change_(imu_.next()));
    test::take(image, &tracker_);
  }

  void catchUp() { delay_ = 0.0; }  ///< From the next image on no sample is late.

  double time() const { return tracker_.time(); }
  const std::optional<BodyEstimate>& estimate() const { return tracker_.bodies()[0]; }

 private:
  static tracking::test::SceneOptions options() {
    tracking::test::SceneOptions options;
    options.pixel_noise = 0.5;
    options.hidden = [](std::size_t, std::size_t, double t) { return hiddenSince(t) > 0.0; };
    return options;
  }
  static BodyTrackerOptions trackerOptions() {
    BodyTrackerOptions options;
    options.prediction_time = 2.0 * kHidden;
    return options;
  }

  tracking::test::Scene scene_;
  BodyTracker tracker_;
  Imu imu_;
  Change change_;
  double delay_, end_;
};

/// Errors at the ends of the times hidden, and while in view.
struct Score {
  double hidden = 0.0, longest = 0.0, seen = 0.0, turn = 0.0;  // RMS, greatest, RMS [m], RMS [rad]
  double hidden_nees = 0.0, seen_nees = 0.0;                   // per coordinate
};

Score scoreOf(double delay, double end = kNever) {
  Score score;
  double hidden = 0.0, seen = 0.0;
  for (unsigned seed = 1; seed <= 2; ++seed) {
    Carried body(seed, delay, end);
    double error = 0.0, nees = 0.0;
    bool was_hidden = false;
    for (body.step(); body.time() < kStart + kLearning + 7.0 * kPeriod; body.step()) {
      const double since = hiddenSince(body.time());
      if (was_hidden && since < 0.0) {  // of the image before
        hidden += 1.0;
        score.hidden += error * error;
        score.longest = std::max(score.longest, error);
        score.hidden_nees += nees;
      }
      was_hidden = since > 0.0;
      EXPECT_TRUE(body.estimate() || since <= 0.0) << "lost while hidden";
      if (!body.estimate())
        continue;
      const BodyEstimate& found = *body.estimate();
      const Isometry3d truth = carried(body.time());
      error = (found.world_from_body.translation() - truth.translation()).norm();
      nees = test::normalisedError(truth, found.world_from_body,
                                   found.covariance.topLeftCorner<6, 6>()) /
             6.0;
      if (since > 0.05) {
        EXPECT_FALSE(found.tracked);
        EXPECT_EQ(found.inertial, end == kNever);
      } else if (since < -0.5 && body.time() > kStart + kLearning) {
        seen += 1.0;
        score.seen += error * error;
        score.seen_nees += nees;
        score.turn += test::rotationError(truth, found.world_from_body).squaredNorm();
      }
    }
  }
  score.hidden = std::sqrt(score.hidden / hidden);
  score.hidden_nees /= hidden;
  score.seen = std::sqrt(score.seen / seen);
  score.turn = std::sqrt(score.turn / seen);
  score.seen_nees /= seen;
  return score;
}

void record(const Score& score) {
  const auto property = [](const char* name, double value) {
    testing::Test::RecordProperty(name, std::to_string(value));
  };
  property("hidden_rms", score.hidden);
  property("hidden_greatest", score.longest);
  property("hidden_nees", score.hidden_nees);
  property("seen_rms", score.seen);
  property("seen_turn_rms", score.turn);
  property("seen_nees", score.seen_nees);
}

TEST(InertialBody, IsBridgedWhileHidden) {
  const Score score = scoreOf(0.0);
  record(score);
  EXPECT_LT(score.longest, 0.02);
  EXPECT_GT(score.hidden_nees, 0.6);
  EXPECT_LT(score.hidden_nees, 1.4);
  EXPECT_GT(score.seen_nees, 0.6);
  EXPECT_LT(score.seen_nees, 1.4);
}

TEST(InertialBody, BridgesWithSamplesThatComeLate) {
  const Score score = scoreOf(0.02);
  record(score);
  EXPECT_LT(score.hidden, 0.02);
}

TEST(InertialBody, IsAnOrdinaryBodyWithoutSamples) {
  const Score score = scoreOf(0.0, kStart - 1.0);
  record(score);
  EXPECT_GT(score.hidden, 0.05);
}

TEST(InertialBody, IsAnOrdinaryBodyOnceItsImuPauses) {
  const double end = kStart + kLearning + 0.6;
  Carried body(3, 0.0, end);
  for (body.step(); body.time() < end + 0.04; body.step()) {
  }
  ASSERT_TRUE(body.estimate());
  EXPECT_TRUE(body.estimate()->inertial);
  for (; body.time() < end + 0.1; body.step()) {
  }
  ASSERT_TRUE(body.estimate());
  EXPECT_TRUE(body.estimate()->tracked);
  EXPECT_FALSE(body.estimate()->inertial);
  EXPECT_LT(
      (body.estimate()->world_from_body.translation() - carried(body.time()).translation()).norm(),
      0.01);
}

TEST(InertialBody, IsAnOrdinaryBodyWhereItsImuContradictsTheImages) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(M_PI / 2.0, Vector3d(1.0, 1.0, 1.0).normalized()).toRotationMatrix();
  const std::pair<const char*, Change> wrong[] = {
      {"in g",
       [](InertialSample s) {
         s.force /= 9.80665;
         return s;
       }},
      {"degrees",
       [](InertialSample s) {
         s.rate *= 180.0 / M_PI;
         return s;
       }},
      {"does not turn",
       [](InertialSample s) {
         s.rate.setZero();
         return s;
       }},
      {"mounted otherwise",
       [&](const InertialSample& s) {
         return InertialSample{s.time, turn * s.rate, turn * s.force};
       }},
      {"another clock",
       [](InertialSample s) {
         s.time += 0.3;
         return s;
       }},
  };
  for (const auto& [what, change] : wrong) {
    Carried body(4, 0.0, kNever, change);
    double images = 0.0, inertial = 0.0, squares = 0.0, greatest = 0.0;
    for (body.step(); body.time() < kStart + kLearning; body.step()) {
      if (!body.estimate() || !body.estimate()->tracked)
        continue;
      const double error =
          (body.estimate()->world_from_body.translation() - carried(body.time()).translation())
              .norm();
      images += 1.0;
      inertial += body.estimate()->inertial ? 1.0 : 0.0;
      squares += error * error;
      greatest = std::max(greatest, error);
    }
    RecordProperty(what, std::to_string(greatest));
    EXPECT_GT(images, 1500.0) << what;
    EXPECT_LT(inertial, 0.1 * images) << what;
    EXPECT_LT(std::sqrt(squares / images), 0.003) << what;
    EXPECT_LT(greatest, 0.03) << what;
  }
}

TEST(InertialBody, TriesAnImuThatStaysWrongEverMoreRarely) {
  Carried body(6, 0.0, kNever, [](InertialSample s) {
    s.force /= 9.80665;
    return s;
  });
  std::vector<double> starts;  // [s]
  bool was_inertial = false;
  for (body.step(); body.time() < kStart + 75.0; body.step()) {
    const bool is_inertial = body.estimate() && body.estimate()->inertial;
    if (is_inertial && !was_inertial)
      starts.push_back(body.time() - kStart);
    was_inertial = is_inertial;
  }
  ASSERT_EQ(starts.size(), 4U);
  EXPECT_NEAR(starts[1] - starts[0], 10.0, 2.0);
  EXPECT_NEAR(starts[2] - starts[1], 20.0, 2.0);
  EXPECT_NEAR(starts[3] - starts[2], 40.0, 2.0);
}

TEST(InertialBody, DoesNotDependOnWhenItsSamplesCome) {
  Carried early(5), late(5, 0.02);
  for (early.step(), late.step(); early.time() < kStart + 3.0; early.step(), late.step()) {
  }
  ASSERT_TRUE(early.estimate() && late.estimate());
  EXPECT_NE(early.estimate()->covariance, late.estimate()->covariance);
  late.catchUp();
  early.step();
  late.step();
  EXPECT_EQ(early.estimate()->covariance, late.estimate()->covariance);
  EXPECT_EQ(early.estimate()->world_from_body.matrix(), late.estimate()->world_from_body.matrix());
}

}  // namespace
}  // namespace wiimote_tracker::body
