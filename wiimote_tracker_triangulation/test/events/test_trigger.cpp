// Points at a requested time: exact where the motion model holds, with a conservative covariance,
// independent of the time of the request; and every reason for a refusal.
#include "events/trigger.h"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include <cmath>
#include <optional>
#include <random>
#include <vector>

namespace wiimote_tracker::events {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using tracking::Snapshot;
using tracking::TrackedLed;
using tracking::TrackState;

constexpr double kStart = 1.7e9;  // [s since 1970]

TrackedLed ledAt(const Vector3d& position, const std::optional<Vector3d>& velocity = {}) {
  TrackedLed led;
  led.id = 3;
  led.state = TrackState::kTracked;
  led.position = position;
  led.position_covariance = 1e-6 * Matrix3d::Identity();
  led.velocity = velocity;
  if (velocity)
    led.velocity_covariance = 1e-4 * Matrix3d::Identity();
  return led;
}

Snapshot snapshot(double time, const std::vector<TrackedLed>& leds) {
  Snapshot result;
  result.time = kStart + time;
  result.latest_arrival = kStart + time + 0.01;
  result.leds = leds;
  return result;
}

/// x = t, every 10 ms from 0 s, velocity unknown.
Snapshot walking(int i) {
  return snapshot(0.01 * i, {ledAt({0.01 * i, 0.0, 0.0})});
}

TriggerAnswer only(Trigger* trigger) {
  const TriggerAnswer* answer = trigger->next();
  if (!answer) {
    ADD_FAILURE() << "no answer";
    return {};
  }
  const TriggerAnswer result = *answer;
  EXPECT_EQ(nullptr, trigger->next());
  return result;
}

TEST(Interpolate, IsExactForACubicWithItsVelocities) {
  const Vector3d a(1.0, 2.0, 3.0), b(-2.0, 0.5, 1.0), c(30.0, -20.0, 10.0), d(-400.0, 300.0, 100.0);
  const auto position = [&](double t) { return Vector3d(a + t * (b + t * (c + t * d))); };
  const auto velocity = [&](double t) { return Vector3d(b + t * (2.0 * c + t * 3.0 * d)); };
  const double t1 = 0.02, t2 = 0.05;
  for (const double t : {0.021, 0.03, 0.035, 0.049}) {
    const TrackedLed led = interpolate(ledAt(position(t1), velocity(t1)), t1,
                                       ledAt(position(t2), velocity(t2)), t2, t);
    EXPECT_LT((led.position - position(t)).norm(), 1e-14);
  }
}

TEST(Interpolate, IsAStraightLineWithoutVelocities) {
  const TrackedLed led =
      interpolate(ledAt({0.0, 0.0, 1.0}), 10.0, ledAt({1.0, 2.0, 1.0}), 12.0, 10.5);
  EXPECT_LT((led.position - Vector3d(0.25, 0.5, 1.0)).norm(), 1e-15);
  EXPECT_FALSE(led.velocity);
}

/// The error of the interpolated position never exceeds the covariance, however the errors of both
/// ends are correlated; and at the ends it is theirs.
TEST(Interpolate, CovarianceHoldsForEveryCorrelation) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  const auto randomMatrix = [&] {
    Matrix3d m;
    for (int i = 0; i < 9; ++i)
      m(i) = normal(random);
    return m;
  };
  for (int round = 0; round < 200; ++round) {
    TrackedLed before = ledAt(Vector3d::Zero(), Vector3d::Zero());
    TrackedLed after = before;
    // Errors A x and B x of the same x: fully correlated, in one way or the other.
    const Matrix3d A = 1e-3 * randomMatrix();
    const Matrix3d B = 1e-3 * randomMatrix();
    before.position_covariance = A * A.transpose();
    after.position_covariance = B * B.transpose();
    const Matrix3d V = 0.1 * randomMatrix();
    before.velocity_covariance = V * V.transpose();
    const double duration = 0.03;
    for (const double s : {0.0, 0.1, 0.5, 0.8, 1.0}) {
      const TrackedLed led = interpolate(before, 0.0, after, duration, s * duration);
      // Weights of the inputs; the interpolation is linear in them.
      TrackedLed shifted = before;
      shifted.position = Vector3d::Ones();
      const double w_before =
          (interpolate(shifted, 0.0, after, duration, s * duration).position - led.position).x();
      shifted = after;
      shifted.position = Vector3d::Ones();
      const double w_after =
          (interpolate(before, 0.0, shifted, duration, s * duration).position - led.position).x();
      shifted = before;
      shifted.velocity = Vector3d(Vector3d::Ones());
      const double w_velocity =
          (interpolate(shifted, 0.0, after, duration, s * duration).position - led.position).x();
      EXPECT_NEAR(1.0, w_before + w_after, 1e-12);
      const Matrix3d error = w_before * A + w_after * B;
      const Matrix3d actual =
          error * error.transpose() + w_velocity * w_velocity * before.velocity_covariance;
      const double least = Eigen::SelfAdjointEigenSolver<Matrix3d>(led.position_covariance - actual)
                               .eigenvalues()
                               .minCoeff();
      EXPECT_GT(least, -1e-12 * led.position_covariance.norm() - 1e-18);
      if (s == 0.0 || s == 1.0) {
        EXPECT_LT((led.position_covariance - actual).norm(), 1e-15);
      }
    }
  }
}

TEST(Interpolate, VelocityCovarianceCountsByItsWeight) {
  TrackedLed end = ledAt(Vector3d::Zero(), Vector3d::Zero());
  end.position_covariance.setZero();
  // In the middle a velocity counts by an eighth of the duration.
  const TrackedLed led = interpolate(end, 10.0, end, 10.4, 10.2);
  const Matrix3d expected = 2.0 * 0.05 * 0.05 * end.velocity_covariance;
  EXPECT_LT((led.position_covariance - expected).norm(), 1e-12 * expected.norm());
}

TEST(Interpolate, TheVelocityChangesSteadily) {
  TrackedLed before = ledAt(Vector3d::Zero(), Vector3d(1.0, 0.0, -2.0));
  TrackedLed after = ledAt(Vector3d::Zero(), Vector3d(5.0, 0.0, 2.0));
  before.velocity_covariance = 1.0 * Matrix3d::Identity();
  after.velocity_covariance = 3.0 * Matrix3d::Identity();
  const TrackedLed led = interpolate(before, 10.0, after, 12.0, 10.5);
  ASSERT_TRUE(led.velocity);
  EXPECT_LT((*led.velocity - Vector3d(2.0, 0.0, -1.0)).norm(), 1e-12);
  EXPECT_LT((led.velocity_covariance - 1.5 * Matrix3d::Identity()).norm(), 1e-12);
}

TEST(Interpolate, TakesTheLessCertainStateAndTheNearerRays) {
  TrackedLed before = ledAt(Vector3d::Zero());
  TrackedLed after = ledAt(Vector3d::Zero());
  before.first_seen = after.first_seen = 1.0;
  before.last_observed = 10.0;
  after.last_observed = 12.0;
  before.cameras = {0, 1};
  after.cameras = {2, 3};
  after.state = TrackState::kPredicted;
  const TrackedLed led = interpolate(before, 10.0, after, 12.0, 11.5);
  EXPECT_EQ(TrackState::kPredicted, led.state);
  EXPECT_EQ(after.cameras, led.cameras);
  EXPECT_EQ(11.5, led.last_observed) << "not in the future of the point";
  EXPECT_EQ(before.cameras, interpolate(before, 10.0, after, 12.0, 10.5).cameras);
}

TEST(Trigger, WaitsForALaterSnapshot) {
  Trigger trigger{TriggerOptions()};
  for (int i = 0; i < 10; ++i)
    trigger.add(walking(i));
  trigger.ask(kStart + 0.094, 41);
  EXPECT_EQ(nullptr, trigger.next());
  trigger.add(walking(10));
  const TriggerAnswer answer = only(&trigger);
  EXPECT_EQ(TriggerResult::kAnswered, answer.result);
  EXPECT_EQ(41u, answer.request);
  EXPECT_EQ(kStart + 0.094, answer.snapshot.time);
  ASSERT_EQ(1u, answer.snapshot.leds.size());
  // Seconds since 1970 are counted in steps of 0.24 us.
  EXPECT_LT((answer.snapshot.leds[0].position - Vector3d(0.094, 0.0, 0.0)).norm(), 1e-6);
  EXPECT_EQ(3u, answer.snapshot.leds[0].id);
  EXPECT_EQ(kStart + 0.11, answer.snapshot.latest_arrival);
}

TEST(Trigger, ItsSkewIsTheLargerOfBothSnapshots) {
  for (const bool first_is_worse : {false, true}) {
    Trigger trigger{TriggerOptions()};
    for (const int i : {0, 1}) {
      Snapshot shown = walking(i);
      shown.skew = (i == 0) == first_is_worse ? 0.009 : 0.002;
      trigger.add(shown);
    }
    trigger.ask(kStart + 0.005, 1);
    EXPECT_EQ(0.009, only(&trigger).snapshot.skew);
  }
}

TEST(Trigger, TheTimeOfASnapshotGivesThatSnapshot) {
  Trigger trigger{TriggerOptions()};
  for (int i = 0; i < 5; ++i)
    trigger.add(walking(i));
  for (const int i : {0, 2, 4}) {
    trigger.ask(walking(i).time, 1);
    const TriggerAnswer answer = only(&trigger);
    ASSERT_EQ(1u, answer.snapshot.leds.size());
    EXPECT_EQ(walking(i).leds[0].position, answer.snapshot.leds[0].position);
    EXPECT_EQ(walking(i).leds[0].position_covariance, answer.snapshot.leds[0].position_covariance);
  }
}

TEST(Trigger, TheAnswerDoesNotDependOnTheTimeOfTheRequest) {
  std::vector<Vector3d> positions;
  for (const int asked_at : {0, 1, 30, 31, 99}) {
    Trigger trigger{TriggerOptions()};
    for (int i = 0; i < 100; ++i) {
      if (i == asked_at)
        trigger.ask(kStart + 0.3033, 1);
      trigger.add(walking(i));
      while (const TriggerAnswer* answer = trigger.next())
        positions.push_back(answer->snapshot.leds.at(0).position);
    }
  }
  ASSERT_EQ(5u, positions.size());
  for (const Vector3d& position : positions)
    EXPECT_EQ(positions[0], position);
}

TEST(Trigger, AnswersSeveralEachOnce) {
  Trigger trigger{TriggerOptions()};
  trigger.ask(kStart + 0.5, 1);
  trigger.ask(kStart + 0.1, 2);
  trigger.ask(kStart + 0.5, 3);
  std::vector<std::uint64_t> requests;
  for (int i = 0; i <= 60; ++i) {
    trigger.add(walking(i));
    while (const TriggerAnswer* answer = trigger.next()) {
      EXPECT_EQ(TriggerResult::kAnswered, answer->result);
      requests.push_back(answer->request);
    }
  }
  EXPECT_EQ((std::vector<std::uint64_t>{2, 1, 3}), requests);
}

TEST(Trigger, OmitsLedsMissingInOneSnapshot) {
  Trigger trigger{TriggerOptions()};
  TrackedLed other = ledAt({1.0, 0.0, 0.0});
  other.id = 5;
  TrackedLed lost = ledAt({2.0, 0.0, 0.0});
  lost.id = 6;
  trigger.add(snapshot(0.0, {ledAt({0.0, 0.0, 0.0}), lost}));
  lost.state = TrackState::kLost;
  trigger.add(snapshot(0.01, {ledAt({0.0, 0.0, 0.0}), other, lost}));
  trigger.ask(kStart + 0.005, 1);
  const TriggerAnswer answer = only(&trigger);
  EXPECT_EQ(TriggerResult::kAnswered, answer.result);
  ASSERT_EQ(1u, answer.snapshot.leds.size());
  EXPECT_EQ(3u, answer.snapshot.leds[0].id);
}

TEST(Trigger, AnswersForAnEmptyRoom) {
  Trigger trigger{TriggerOptions()};
  trigger.add(snapshot(0.0, {}));
  trigger.add(snapshot(0.01, {}));
  trigger.ask(kStart + 0.005, 1);
  const TriggerAnswer answer = only(&trigger);
  EXPECT_EQ(TriggerResult::kAnswered, answer.result);
  EXPECT_TRUE(answer.snapshot.leds.empty());
}

TEST(Trigger, RefusesBeyondGaps) {
  Trigger trigger{TriggerOptions()};
  trigger.ask(kStart + 0.1, 1);
  trigger.add(walking(0));
  EXPECT_EQ(nullptr, trigger.next());
  trigger.add(walking(20));
  EXPECT_EQ(TriggerResult::kGap, only(&trigger).result);
}

TEST(Trigger, RefusesTimesBeforeItsHistory) {
  TriggerOptions options;
  options.history = 0.5;
  Trigger trigger(options);
  for (int i = 0; i <= 200; ++i)
    trigger.add(walking(i));
  trigger.ask(kStart + 1.505, 1);
  EXPECT_EQ(TriggerResult::kAnswered, only(&trigger).result);
  trigger.ask(kStart + 1.4, 2);
  EXPECT_EQ(TriggerResult::kTooOld, only(&trigger).result);
  trigger.ask(0.0, 3);
  EXPECT_EQ(TriggerResult::kNoTime, only(&trigger).result) << "its stamp was not set";
}

TEST(Trigger, KeepsTheSnapshotJustBeforeItsHistory) {
  TriggerOptions options;
  options.history = 0.5;
  Trigger trigger(options);
  for (int i = 0; i < 17; ++i)
    trigger.add(snapshot(0.04 * i, {ledAt({0.04 * i, 0.0, 0.0})}));
  // The newest is of 0.64 s; 0.15 s lies between the snapshots of 0.12 and 0.16 s.
  trigger.ask(kStart + 0.15, 1);
  EXPECT_EQ(TriggerResult::kAnswered, only(&trigger).result);
}

TEST(Trigger, KeepsItsHistoryAtAGrowingRate) {
  TriggerOptions options;
  options.maximum_gap = 1.0;
  Trigger trigger(options);
  double time = 0.0;
  for (int i = 0; i < 60; ++i) {
    time += 0.5 * std::pow(0.9, i);
    trigger.add(snapshot(time, {ledAt({time, 0.0, 0.0})}));
  }
  for (double asked = time - 2.0; asked < time; asked += 0.1) {
    trigger.ask(kStart + asked, 1);
    const TriggerAnswer answer = only(&trigger);
    ASSERT_EQ(TriggerResult::kAnswered, answer.result);
    EXPECT_NEAR(asked, answer.snapshot.leds.at(0).position.x(), 1e-6);
  }
}

TEST(Trigger, RefusesTheFarFuture) {
  Trigger trigger{TriggerOptions()};
  trigger.ask(kStart + 1e6, 1);
  EXPECT_EQ(nullptr, trigger.next()) << "the time is not known yet";
  trigger.add(walking(0));
  EXPECT_EQ(TriggerResult::kTooEarly, only(&trigger).result);
  trigger.ask(kStart + 1.9, 2);
  EXPECT_EQ(nullptr, trigger.next());
  trigger.ask(kStart + 2.1, 3);
  EXPECT_EQ(TriggerResult::kTooEarly, only(&trigger).result);
}

TEST(Trigger, RefusesTooManyPendingRequests) {
  Trigger trigger{TriggerOptions()};
  for (std::size_t i = 0; i <= Trigger::kMaximumPending; ++i)
    trigger.ask(kStart, i);
  const TriggerAnswer answer = only(&trigger);
  EXPECT_EQ(TriggerResult::kTooMany, answer.result);
  EXPECT_EQ(Trigger::kMaximumPending, answer.request);
}

TEST(Trigger, FinishAnswersAllPendingRequests) {
  Trigger trigger{TriggerOptions()};
  trigger.add(walking(0));
  trigger.ask(kStart + 0.005, 1);
  EXPECT_EQ(nullptr, trigger.next());
  trigger.finish();
  EXPECT_EQ(TriggerResult::kGap, only(&trigger).result);
}

TEST(Trigger, AnswersFromTheSnapshotsSinceItForgotThem) {
  Trigger trigger{TriggerOptions()};
  trigger.add(walking(50));
  trigger.add(walking(51));
  trigger.forget();
  trigger.add(walking(0));
  trigger.ask(kStart + 0.505, 1);
  EXPECT_EQ(nullptr, trigger.next());
  for (int i = 1; i <= 51; ++i)
    trigger.add(snapshot(0.01 * i, {ledAt({0.0, 0.0, 1.0})}));
  const TriggerAnswer answer = only(&trigger);
  ASSERT_EQ(TriggerResult::kAnswered, answer.result);
  EXPECT_EQ(1.0, answer.snapshot.leds.at(0).position.z());
}

TEST(Trigger, EveryRefusalHasAText) {
  for (const TriggerResult result :
       {TriggerResult::kGap, TriggerResult::kNoTime, TriggerResult::kTooOld,
        TriggerResult::kTooEarly, TriggerResult::kTooMany})
    EXPECT_NE(std::string::npos, describe(result, TriggerOptions()).find(": "));
}

}  // namespace
}  // namespace wiimote_tracker::events
