// People: the LEDs that they carry and hide; reflections; and that people_rig.yaml can be tracked.

#include "rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace wiimote_tracker::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Uniform in [low, high), the same with every library.
class Random {
 public:
  double operator()(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
  }
  Vector3d place() {
    const double x = (*this)(-1.0, 1.0), y = (*this)(-1.0, 1.0);
    return {x, y, (*this)(-0.5, 2.5)};
  }

 private:
  std::mt19937 engine_{7};
};

TEST(Cylinder, hides_points_behind_it) {
  const Cylinder cylinder{Vector3d(1.0, 0.0, 0.0), 0.2, 1.8};
  const Vector3d from(0.0, 0.0, 1.0);
  EXPECT_TRUE(cylinder.hides(from, Vector3d(2.0, 0.0, 1.0)));
  EXPECT_TRUE(cylinder.hides(from, Vector3d(2.0, 0.35, 1.0)));
  EXPECT_FALSE(cylinder.hides(from, Vector3d(2.0, 0.5, 1.0))) << "beside it";
  EXPECT_FALSE(cylinder.hides(from, Vector3d(0.7, 0.0, 1.0))) << "before it";
  EXPECT_FALSE(cylinder.hides(from, Vector3d(-2.0, 0.0, 1.0))) << "in the opposite direction";
  EXPECT_FALSE(cylinder.hides(Vector3d(0.0, 0.0, 2.0), Vector3d(2.0, 0.0, 2.0))) << "above it";
  EXPECT_TRUE(cylinder.hides(Vector3d(0.0, 0.0, 2.0), Vector3d(2.0, 0.0, 1.0))) << "down into it";
  EXPECT_TRUE(cylinder.hides(Vector3d(1.0, 0.0, 3.0), Vector3d(1.0, 0.0, 1.0))) << "from above";
  EXPECT_FALSE(cylinder.hides(Vector3d(1.3, 0.0, 3.0), Vector3d(1.3, 0.0, 0.0))) << "straight down";
}

TEST(Cylinder, agrees_with_steps_along_the_line) {
  Random random;
  const int steps = 2000;
  int hidden = 0;
  for (int i = 0; i < 2000; ++i) {
    const Cylinder cylinder{random.place().cwiseProduct(Vector3d(1, 1, 0)), random(0.05, 0.5),
                            random(0.5, 2.0)};
    const Vector3d from = random.place(), to = random.place();
    const auto inside = [&](double margin) {
      for (int s = 0; s <= steps; ++s) {
        const Vector3d at = from + (to - from) * s / steps - cylinder.foot;
        if (at.head<2>().norm() <= cylinder.radius + margin && at.z() >= -margin &&
            at.z() <= cylinder.height + margin)
          return true;
      }
      return false;
    };
    const double margin = 2.0 * (to - from).norm() / steps;
    if (inside(-margin)) {
      EXPECT_TRUE(cylinder.hides(from, to));
      ++hidden;
    } else if (!inside(margin)) {
      EXPECT_FALSE(cylinder.hides(from, to));
    }
  }
  EXPECT_GT(hidden, 150);
}

CameraDescription cameraAt(const std::string& name, const Vector3d& position) {
  CameraDescription description;
  description.camera.name = name;
  description.camera.world_from_camera =
      geometry::lookAt(position, Vector3d(0, 0, 1), Vector3d::UnitZ());
  description.timing = {0.01, 0.0, 0.0, 0.0};
  return description;
}

/// Camera "front" looks along +x at the origin, "back" along -x. A person stands in the origin and
/// holds an LED in front.
Description carriedLed() {
  Description description;
  description.pixel_noise = 0.0;
  description.truth_rate = 100.0;
  description.cameras = {cameraAt("front", {5, 0, 1}), cameraAt("back", {-5, 0, 1})};
  PersonDescription person;
  person.name = "anna";
  person.turn_rate = M_PI;  // half a turn each second
  description.people = {person};
  LedDescription led;
  led.name = "led";
  led.carried_by = "anna";
  led.motion = LedMotion(Vector3d(0.3, 0.0, 1.0));
  description.leds = {led};
  return description;
}

/// What the cameras see, and the truth about the first LED.
struct Watched {
  explicit Watched(const Description& description)
      : rig(
            description,
            [this](std::size_t camera, const virtual_wiimote::Senses& senses) {
              lights[camera] = senses.lights;
            },
            [this](std::size_t, double, const Vector3d& position) { truth = position; }) {}
  std::vector<virtual_wiimote::Light> lights[2];
  Vector3d truth;
  Rig rig;
};

TEST(Person, carries_an_led_and_turns_with_it) {
  Description description = carriedLed();
  LedMotion& motion = description.people[0].motion;
  motion.line(0.0, Vector3d(0.0, 0.2, 1.0), std::sqrt(1.04));  // for a second
  Watched watched(description);
  watched.rig.runUntil(0.0);
  EXPECT_LT((watched.truth - Vector3d(0.3, 0.0, 1.0)).norm(), 1e-12);
  watched.rig.runUntil(0.5);  // half of the way, and a quarter turn
  EXPECT_LT((watched.truth - Vector3d(0.0, 0.3 + 0.1, 1.0)).norm(), 1e-12)
      << "they stay on the floor";
}

TEST(Person, hides_points_behind_them) {
  Watched watched(carriedLed());
  watched.rig.runUntil(0.005);
  EXPECT_EQ(watched.lights[0].size(), 1u) << "before the body";
  EXPECT_EQ(watched.lights[1].size(), 0u) << "behind it";
  watched.rig.runUntil(1.005);
  EXPECT_EQ(watched.lights[0].size(), 0u) << "half a turn later";
  EXPECT_EQ(watched.lights[1].size(), 1u);
}

TEST(Person, an_absent_person_hides_nothing_and_takes_their_leds_along) {
  Description description = carriedLed();
  LedDescription other;
  other.name = "other";
  other.motion = LedMotion(Vector3d(-0.5, 0.0, 1.0));
  other.size = 7.0;
  description.leds.push_back(other);
  Watched watched(description);
  watched.rig.runUntil(0.005);
  ASSERT_EQ(watched.lights[0].size(), 1u);
  EXPECT_FALSE(watched.lights[0][0].size) << "the one that is carried";
  watched.rig.findPerson("anna")->present = false;
  watched.rig.runUntil(0.015);
  for (const auto& lights : watched.lights) {
    ASSERT_EQ(lights.size(), 1u) << "the other one only";
    EXPECT_EQ(lights[0].size, 7.0);
  }
  EXPECT_EQ(watched.rig.findPerson("ben"), nullptr);
}

TEST(Person, an_absent_person_takes_the_other_end_of_their_wand_along) {
  Description description = carriedLed();
  LedDescription end;
  end.name = "end";
  end.turns = TurnDescription{"led", 0.4, 0.0};
  description.leds.push_back(end);
  Watched watched(description);
  watched.rig.runUntil(0.005);
  ASSERT_EQ(watched.lights[0].size(), 2u);
  watched.rig.findPerson("anna")->present = false;
  watched.rig.runUntil(0.015);
  EXPECT_TRUE(watched.lights[0].empty());
}

TEST(RigidBody, carries_leds_and_turns_with_them) {
  Description description = carriedLed();
  description.people.clear();
  RigidBodyDescription body;
  body.name = "anna";
  body.motion = LedMotion(Vector3d(0.0, 0.0, 1.0));
  body.motion.line(0.0, Vector3d(0.0, 1.0, 1.0), 1.0);
  body.turning.axis = Vector3d(0.0, 3.0, 0.0);
  body.turning.rate = M_PI;
  description.bodies = {body};
  description.leds[0].motion = LedMotion(Vector3d(0.3, 0.1, 0.0));
  Eigen::Isometry3d pose;
  std::vector<Vector3d> positions;
  std::size_t lights = 0;
  Rig rig(
      description, [&](std::size_t, const Image& image) { lights = image.lights.size(); },
      [&](std::size_t, double, const Vector3d& position) { positions.push_back(position); },
      [&](std::size_t, double, const Eigen::Isometry3d& truth) { pose = truth; });
  rig.runUntil(0.5);  // half of the way, and a quarter turn about y: x goes to -z
  EXPECT_LT((positions.back() - Vector3d(0.0, 0.6, 0.7)).norm(), 1e-9);
  EXPECT_LT((pose.translation() - Vector3d(0.0, 0.5, 1.0)).norm(), 1e-9);
  EXPECT_LT((pose.linear().col(0) - Vector3d(0.0, 0.0, -1.0)).norm(), 1e-9);
  EXPECT_EQ(lights, 1u);
  ASSERT_TRUE(rig.findBody("anna"));
  EXPECT_FALSE(rig.findBody("ben"));
  rig.findBody("anna")->present = false;
  rig.runUntil(0.6);
  EXPECT_EQ(lights, 0u) << "it is away";
}

TEST(RigidBody, sways_and_returns) {
  RigidBodyDescription body;
  body.turning.sway = 0.5;
  body.turning.sway_rate = M_PI;
  EXPECT_LT((worldFrom(body, 0.0).linear() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  // After half a second, the full angle about z: nodding does not change the azimuth of x.
  const Vector3d x = worldFrom(body, 0.5).linear().col(0);
  EXPECT_NEAR(std::atan2(x.y(), x.x()), 0.5, 1e-9);
  EXPECT_NEAR(x.z(), 0.0, 1e-9);
  EXPECT_GT(std::abs(worldFrom(body, 0.5).linear().col(1).z()), 0.01) << "it nods";
  const Vector3d back = worldFrom(body, 1.0).linear().col(0);
  EXPECT_NEAR(std::atan2(back.y(), back.x()), 0.0, 1e-9);
  const Vector3d other_side = worldFrom(body, 1.5).linear().col(0);
  EXPECT_NEAR(std::atan2(other_side.y(), other_side.x()), -0.5, 1e-9);
}

TEST(RigidBody, body_rig_has_the_body_that_is_known) {
  const Description description = readDescription(SIMULATION_FOLDER "/body_rig.yaml");
  ASSERT_EQ(description.bodies.size(), 1u);
  EXPECT_EQ(description.bodies[0].name, "wand");
  EXPECT_EQ(std::count_if(description.leds.begin(), description.leds.end(),
                          [](const LedDescription& led) { return led.carried_by == "wand"; }),
            4);
  const RigidBodyDescription& body = description.bodies[0];
  for (int i = 0; i < 600; ++i) {
    for (const CameraDescription& camera : description.cameras)
      EXPECT_TRUE(camera.camera.sees(worldFrom(body, 0.1 * i).translation()));
  }
}

TEST(Reflection, stands_still_in_one_camera_until_it_is_switched_off) {
  Description description = carriedLed();
  ReflectionDescription window;
  window.name = "window";
  window.camera = "back";
  window.pixel = Vector2d(100.0, 200.0);
  window.size = 4.0;
  window.brightness = 2.0;
  description.reflections = {window};
  Watched watched(description);
  watched.rig.runUntil(0.005);
  EXPECT_EQ(watched.lights[0].size(), 1u) << "the LED";
  ASSERT_EQ(watched.lights[1].size(), 1u);
  const virtual_wiimote::Light light = watched.lights[1][0];
  EXPECT_EQ(light.x, 100.0);
  EXPECT_EQ(light.y, 767.0 - 200.0) << "the sensor's y grows upwards";
  EXPECT_EQ(light.size, 4.0);
  EXPECT_EQ(light.brightness, 2.0);
  watched.rig.findReflection("window")->lit = false;
  watched.rig.runUntil(0.015);
  EXPECT_TRUE(watched.lights[1].empty());
  EXPECT_EQ(watched.rig.findReflection("door"), nullptr);
}

class PeopleRig : public testing::Test {
 protected:
  Vector3d placeOf(const LedDescription& led, double time) const {
    return worldFrom(*findNamed(description_.people, led.carried_by), time) *
           led.motion.position(time);
  }

  bool isHidden(const geometry::Camera& camera, const Vector3d& place, double time) const {
    return std::any_of(description_.people.begin(), description_.people.end(),
                       [&](const PersonDescription& person) {
                         return cylinderOf(person, time).hides(camera.center(), place);
                       });
  }

  bool isSeen(const geometry::Camera& camera, const Vector3d& place, double time) const {
    return camera.sees(place) && !isHidden(camera, place, time);
  }

  const Description description_ = readDescription(SIMULATION_FOLDER "/people_rig.yaml");
  static constexpr double kStep = 0.02;  // [s]
  static constexpr int kSteps = 6000;    // two minutes
};

TEST_F(PeopleRig, four_leds_stay_in_the_papers_cube_and_are_sometimes_hidden) {
  ASSERT_EQ(description_.leds.size(), 4u);
  ASSERT_EQ(description_.people.size(), 2u);
  int hidden = 0;
  for (int i = 0; i < kSteps; ++i) {
    for (const LedDescription& led : description_.leds) {
      const Vector3d place = placeOf(led, kStep * i);
      ASSERT_GT(place.minCoeff(), 0.0);
      ASSERT_LT(place.maxCoeff(), 2.5);
      for (const CameraDescription& camera : description_.cameras)
        hidden += isHidden(camera.camera, place, kStep * i);
    }
  }
  EXPECT_GT(hidden, kSteps / 10);
}

TEST_F(PeopleRig, two_cameras_always_separate_any_two_leds) {
  constexpr double kApart = 15.0;  // [px]
  int not_apart = 0;
  double nearest = 10.0;
  for (int i = 0; i < kSteps; ++i) {
    const double time = kStep * i;
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const Vector3d place_a = placeOf(description_.leds[a], time);
        const Vector3d place_b = placeOf(description_.leds[b], time);
        nearest = std::min(nearest, (place_a - place_b).norm());
        int views = 0;
        for (const CameraDescription& camera : description_.cameras) {
          const geometry::Camera& c = camera.camera;
          views += isSeen(c, place_a, time) && isSeen(c, place_b, time) &&
                   (*c.project(place_a) - *c.project(place_b)).norm() > kApart;
        }
        not_apart += views < 2;
      }
    }
  }
  EXPECT_EQ(not_apart, 0);
  EXPECT_GT(nearest, 0.2) << "[m]";
}

}  // namespace
}  // namespace wiimote_tracker::simulation
