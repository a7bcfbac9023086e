// Several LEDs, instant by instant: ids, appearance and loss.
#include "fusion/film.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

namespace wiimote_tracker::fusion::test {
namespace {

using Eigen::Vector3d;
using geometry::Rig;
using geometry::test::Random;
using tracking::Snapshot;
using tracking::TrackedLed;
using tracking::TrackState;

/// Four LEDs on circles of their own, 1 m/s; two of them cross each other's way.
Vector3d pathOf(std::size_t led, double t) {
  const double angle = 2.0 * t + 1.3 * static_cast<double>(led);
  const double radius = 0.3 + 0.1 * static_cast<double>(led % 2);
  return {radius * std::cos(angle), radius * std::sin(led % 2 ? angle : -angle),
          0.25 * static_cast<double>(led) - 0.3};
}

struct Crowd {
  std::size_t leds = 4;
  double noise = 0.0;  // [px]
  std::function<bool(std::size_t led, double time)> is_dark = nullptr;
  std::function<Vector3d(std::size_t led, double time)> path = pathOf;
};

/// As film(), of several LEDs, in an order that changes all the time.
std::vector<Delivery> filmCrowd(const Rig& rig, double begin, double end, const Crowd& crowd) {
  Random random(55);
  std::vector<Delivery> deliveries = film(rig, begin, end, still);
  for (Delivery& d : deliveries) {
    d.image.spots.clear();
    for (std::size_t led = 0; led < crowd.leds; ++led) {
      if (crowd.is_dark && crowd.is_dark(led, d.image.stamp))
        continue;
      const auto pixel = rig.cameras[d.camera].camera.project(crowd.path(led, d.image.stamp));
      const double u = pixel->x() + crowd.noise * random.gaussian();
      const double v = pixel->y() + crowd.noise * random.gaussian();
      d.image.spots.push_back(spotAt({u, v}));
    }
    const auto shift =
        static_cast<std::ptrdiff_t>(random.uniform(0.0, static_cast<double>(d.image.spots.size())));
    std::rotate(d.image.spots.begin(), d.image.spots.begin() + shift, d.image.spots.end());
  }
  return deliveries;
}

Rig fourCameras() {
  Random random(54);
  return geometry::test::randomRig(random, 4);
}

/// The LED of the crowd that is nearest to a tracked one.
std::size_t nearest(const TrackedLed& led, double time) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < 4; ++i) {
    if ((pathOf(i, time) - led.position).norm() < (pathOf(best, time) - led.position).norm())
      best = i;
  }
  return best;
}

TEST(InstantFuser, KeepsFourLedsApart) {
  const Rig rig = fourCameras();
  InstantFuser fuser(rig, {});
  Crowd crowd;
  crowd.noise = 0.5;
  std::array<int, 4> id_of_led = {-1, -1, -1, -1};
  int complete = 0;
  const auto instants = fuse(fuser, filmCrowd(rig, 100.0, 103.0, crowd));
  for (const Snapshot& instant : instants) {
    for (const TrackedLed& led : instant.leds) {
      const std::size_t i = nearest(led, instant.time);
      if (id_of_led[i] < 0)
        id_of_led[i] = static_cast<int>(led.id);
      EXPECT_EQ(id_of_led[i], static_cast<int>(led.id)) << instant.time;
      const double stddev = std::sqrt(led.position_covariance.trace());
      EXPECT_LT((led.position - pathOf(i, instant.time)).norm(), 6.0 * stddev);
    }
    complete += instant.leds.size() == 4;
  }
  EXPECT_GT(complete, 0.98 * static_cast<double>(instants.size()));
}

TEST(InstantFuser, AnIdSurvivesAShortAbsenceAndLossIsReportedOnce) {
  const Rig rig = fourCameras();
  InstantFuserOptions options;
  options.maximum_absence = 0.2;
  InstantFuser fuser(rig, options);
  Crowd crowd;
  crowd.leds = 1;
  crowd.is_dark = [](std::size_t, double t) {
    return (t > 100.5 && t < 100.65) || (t > 101.0 && t < 101.5);
  };
  std::vector<double> lost;
  for (const Snapshot& instant : fuse(fuser, filmCrowd(rig, 100.0, 102.0, crowd))) {
    const double t = instant.time;
    for (const TrackedLed& led : instant.leds) {
      if (led.state == TrackState::kLost) {
        lost.push_back(t);
        EXPECT_EQ(0u, led.id);
        EXPECT_TRUE(led.cameras.empty());
        EXPECT_TRUE(std::isnan(led.residual));
        EXPECT_LT(led.last_observed, 101.001);
        EXPECT_LT((led.position - pathOf(0, 101.0)).norm(), 0.02) << "where it was last";
      } else {
        EXPECT_EQ(t < 101.2 ? 0u : 1u, led.id) << t;
        EXPECT_FALSE(crowd.is_dark(0, t)) << t;
      }
    }
  }
  ASSERT_EQ(1u, lost.size());
  EXPECT_NEAR(101.2, lost[0], kPeriod);
}

TEST(InstantFuser, AnLedThatIsThereIsNotTakenForOneThatIsAbsent) {
  // The second LED passes right where the first one went dark.
  const Rig rig = fourCameras();
  InstantFuser fuser(rig, {});
  Crowd crowd;
  crowd.leds = 2;
  crowd.is_dark = [](std::size_t led, double t) { return led == 0 && t > 100.3; };
  crowd.path = [](std::size_t led, double t) {
    return led == 0 ? Vector3d(0.1, 0.0, 0.0) : Vector3d(t - 100.5, 0.0, 0.0);
  };
  std::uint32_t second = 0;
  int with_first = 0;
  int alone = 0;
  for (const Snapshot& instant : fuse(fuser, filmCrowd(rig, 100.0, 100.75, crowd))) {
    for (const TrackedLed& led : instant.leds) {
      const bool is_second = std::abs(led.position.x() - (instant.time - 100.5)) < 1e-3;
      if (is_second && instant.time < 100.3)
        second = led.id;
      with_first += is_second && instant.time < 100.3;
      alone += is_second && instant.time >= 100.3;
      EXPECT_TRUE(!is_second || instant.time < 100.3 || led.id == second) << instant.time;
    }
  }
  EXPECT_GT(with_first, 100);
  EXPECT_GT(alone, 150);
}

TEST(InstantFuser, AnLedIsTentativeAtFirst) {
  const Rig rig = fourCameras();
  InstantFuserOptions options;
  options.confirmations = 5;
  InstantFuser fuser(rig, options);
  Crowd crowd;
  crowd.leds = 1;
  int seen = 0;
  for (const Snapshot& instant : fuse(fuser, filmCrowd(rig, 100.0, 100.3, crowd))) {
    if (const TrackedLed* led = ledOf(instant)) {
      ++seen;
      EXPECT_EQ(seen < 5 ? TrackState::kTentative : TrackState::kTracked, led->state);
    }
  }
  EXPECT_GT(seen, 100);
}

TEST(InstantFuser, RespectsMaximumLeds) {
  const Rig rig = fourCameras();
  InstantFuserOptions options;
  options.maximum_leds = 2;
  InstantFuser fuser(rig, options);
  const auto instants = fuse(fuser, filmCrowd(rig, 100.0, 101.0, {}));
  for (const Snapshot& instant : instants) {
    EXPECT_LE(instant.leds.size(), 2u);
    for (const TrackedLed& led : instant.leds)
      EXPECT_LT(led.id, 2u) << "the others do not push them out";
  }
  EXPECT_EQ(2u, instants.back().leds.size());
}

TEST(InstantFuser, RespectsMinimumRays) {
  const Rig rig = fourCameras();
  InstantFuserOptions options;
  options.minimum_rays = 3;
  InstantFuser fuser(rig, options);
  auto deliveries = film(rig, 100.0, 101.0, still);
  for (Delivery& d : deliveries) {
    if (d.camera == 0 || (d.camera == 1 && d.image.stamp > 100.5))
      d.image.spots.clear();
  }
  const auto instants = fuse(fuser, deliveries);
  EXPECT_GT(instants.size(), 380u);
  for (const Snapshot& instant : instants) {
    const bool is_enough = instant.time < 100.495;
    EXPECT_TRUE(instant.time < 100.05 || is_enough == (ledOf(instant) != nullptr)) << instant.time;
  }
}

TEST(InstantFuser, EveryMethodFindsEveryLed) {
  const Rig rig = fourCameras();
  using geometry::TriangulationMethod;
  for (const auto method :
       {TriangulationMethod::kMeanClosest, TriangulationMethod::kLeastSquares,
        TriangulationMethod::kMaximumLikelihood, TriangulationMethod::kReweightedMidpoint}) {
    InstantFuserOptions options;
    options.triangulation.method = method;
    InstantFuser fuser(rig, options);
    const auto instants = fuse(fuser, filmCrowd(rig, 100.0, 100.3, {}));
    ASSERT_EQ(4u, instants.back().leds.size());
    for (const TrackedLed& led : instants.back().leds) {
      const double time = instants.back().time;
      EXPECT_LT((led.position - pathOf(nearest(led, time), time)).norm(), 1e-4);
    }
  }
}

}  // namespace
}  // namespace wiimote_tracker::fusion::test
