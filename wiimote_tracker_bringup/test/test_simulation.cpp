#include "rig.h"
#include "virtual_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

namespace wiimote_tracker::simulation {
namespace {

using Eigen::Vector3d;

// --- Optics and mounting

geometry::Camera cameraAt(const Vector3d& position, const Vector3d& target) {
  geometry::Camera camera;
  camera.name = "camera";
  camera.intrinsics.fx = camera.intrinsics.fy = 1300.0;
  camera.intrinsics.cx = 500.0;
  camera.intrinsics.cy = 400.0;
  camera.world_from_camera = geometry::lookAt(position, target, Vector3d::UnitZ());
  return camera;
}

TEST(VirtualCamera, projects_like_a_pinhole_with_y_upwards) {
  VirtualCamera optics(cameraAt(Vector3d(0, 0, 1), Vector3d(5, 0, 1)), 0.0, 1);
  // Camera looks along +x: its right is -y, its down is -z.
  const auto senses = optics.sense({{Vector3d(5.0, -0.5, 1.2), 4.0, 2.0}});
  ASSERT_EQ(senses.lights.size(), 1u);
  EXPECT_NEAR(senses.lights[0].x, 500.0 + 1300.0 * 0.1, 1e-9);
  EXPECT_NEAR(senses.lights[0].y, 767.0 - (400.0 - 1300.0 * 0.04), 1e-9);
  EXPECT_EQ(senses.lights[0].size, 4.0);
  EXPECT_EQ(senses.lights[0].brightness, 2.0);
}

TEST(VirtualCamera, dims_a_lamp_without_size_by_its_distance) {
  VirtualCamera optics(cameraAt(Vector3d(0, 0, 1), Vector3d(5, 0, 1)), 0.0, 1);
  const auto senses = optics.sense(
      {{Vector3d(2.0, 0.0, 1.0), std::nullopt, 3.0}, {Vector3d(4.0, 0.0, 1.0), std::nullopt, 3.0}});
  ASSERT_EQ(senses.lights.size(), 2u);
  EXPECT_FALSE(senses.lights[0].size);
  EXPECT_NEAR(senses.lights[0].brightness, 3.0 / 4.0, 1e-12);
  EXPECT_NEAR(senses.lights[1].brightness, 3.0 / 16.0, 1e-12);
}

TEST(VirtualCamera, applies_the_lens_distortion) {
  geometry::Camera camera = cameraAt(Vector3d(0, 0, 1), Vector3d(5, 0, 1));
  camera.intrinsics.distortion[0] = 0.1;
  VirtualCamera optics(camera, 0.0, 1);
  const auto senses = optics.sense({{Vector3d(5.0, -1.0, 1.0), 1.0, 1.0}});
  EXPECT_NEAR(senses.lights.at(0).x, 500.0 + 1300.0 * 0.2 * (1.0 + 0.1 * 0.04), 1e-9);
}

TEST(VirtualCamera, does_not_see_points_behind_it) {
  VirtualCamera optics(cameraAt(Vector3d(0, 0, 1), Vector3d(5, 0, 1)), 0.3, 1);
  EXPECT_TRUE(optics.sense({{Vector3d(-5.0, 0.0, 1.0), 1.0, 1.0}}).lights.empty());
}

TEST(VirtualCamera, adds_noise_of_the_given_size) {
  VirtualCamera optics(cameraAt(Vector3d(0, 0, 1), Vector3d(5, 0, 1)), 0.3, 3);
  const int n = 20000;
  double sum_x = 0.0, sum_xx = 0.0, sum_yy = 0.0, sum_xy = 0.0;
  for (int i = 0; i < n; ++i) {
    const auto light = optics.sense({{Vector3d(5.0, 0.0, 1.0), 1.0, 1.0}}).lights.at(0);
    const double x = light.x - 500.0, y = light.y - 367.0;
    sum_x += x;
    sum_xx += x * x;
    sum_yy += y * y;
    sum_xy += x * y;
  }
  EXPECT_NEAR(sum_x / n, 0.0, 5 * 0.3 / std::sqrt(n));
  EXPECT_NEAR(sum_xx / n, 0.09, 5 * 0.09 * std::sqrt(2.0 / n));
  EXPECT_NEAR(sum_yy / n, 0.09, 5 * 0.09 * std::sqrt(2.0 / n));
  EXPECT_NEAR(sum_xy / n, 0.0, 5 * 0.09 / std::sqrt(n));
}

TEST(VirtualCamera, feels_gravity_as_it_is_mounted) {
  // Level: the remote reads +1 g along its own up axis.
  VirtualCamera level(cameraAt(Vector3d(0, 0, 1), Vector3d(5, 0, 1)), 0.0, 1);
  const auto at_rest = level.sense({}).acceleration;
  EXPECT_NEAR(at_rest[0], 0.0, 1e-12);
  EXPECT_NEAR(at_rest[1], 0.0, 1e-12);
  EXPECT_NEAR(at_rest[2], 1.0, 1e-12);
  // Nose down by 30 degrees: its rear end (+y) points up by as much.
  VirtualCamera pitched(cameraAt(Vector3d(0, 0, 1), Vector3d(std::sqrt(3.0), 0, 0)), 0.0, 1);
  const auto down = pitched.sense({}).acceleration;
  EXPECT_NEAR(down[0], 0.0, 1e-12);
  EXPECT_NEAR(down[1], 0.5, 1e-12);
  EXPECT_NEAR(down[2], std::sqrt(0.75), 1e-12);
}

TEST(VirtualCamera, sees_and_feels_where_it_was_turned_to) {
  const Vector3d position(0, 0, 1);
  const Vector3d target(5, 0.3, 0.8);
  VirtualCamera knocked(cameraAt(position, Vector3d(5, 0, 1)), 0.0, 1);
  VirtualCamera there(cameraAt(position, target), 0.0, 1);
  knocked.lookAt(target);
  const std::vector<Lamp> lamps = {{Vector3d(4, 0.2, 1.1), 3.0, 1.0}};
  const auto seen = knocked.sense(lamps);
  const auto expected = there.sense(lamps);
  EXPECT_EQ(seen.lights.at(0).x, expected.lights.at(0).x);
  EXPECT_EQ(seen.lights.at(0).y, expected.lights.at(0).y);
  EXPECT_EQ(seen.acceleration, expected.acceleration);
}

// --- The whole

const Rig::Truth kNoTruth = [](std::size_t, double, const Vector3d&) {};

/// Appends the horizontal pixel of the first light of each image.
Rig::Deliver pixelsTo(std::vector<double>* x) {
  return [x](std::size_t, const Image& image) { x->push_back(image.lights[0].x); };
}

Description twoCameras() {
  Description description;
  description.seed = 5;
  description.pixel_noise = 0.3;
  description.truth_rate = 100.0;
  description.cameras = {
      {cameraAt(Vector3d(-3, 0, 1), Vector3d(0, 0, 1)), {0.01, 0.002, 0.005, 0.001}},
      {cameraAt(Vector3d(0, -3, 1), Vector3d(0, 0, 1)), {0.0101, 0.007, 0.004, 0.003}}};
  LedDescription led;
  led.name = "led";
  led.motion = LedMotion(Vector3d(0, 0, 1));
  description.leds = {led};
  return description;
}

struct Delivered {
  std::size_t camera;
  double x, y;
  bool operator==(const Delivered& other) const {
    return camera == other.camera && x == other.x && y == other.y;
  }
};

std::vector<Delivered> deliveries(const Description& description, double step) {
  std::vector<Delivered> all;
  Rig rig(
      description,
      [&](std::size_t camera, const virtual_wiimote::Senses& senses) {
        all.push_back({camera, senses.lights.at(0).x, senses.lights.at(0).y});
      },
      kNoTruth);
  for (double time = 0.0; time < 0.5; time += step)
    rig.runUntil(time);
  rig.runUntil(0.5);
  rig.findLed("led")->motion.line(0.5, Vector3d(0.1, 0.2, 1.3), 1.0);
  rig.runUntil(1.0);
  return all;
}

TEST(Rig, gives_the_same_events_for_any_time_steps) {
  const auto once = deliveries(twoCameras(), 10.0);
  EXPECT_GT(once.size(), 190u);
  EXPECT_EQ(once, deliveries(twoCameras(), 0.0007));
  Description other = twoCameras();
  other.seed = 6;
  EXPECT_FALSE(once == deliveries(other, 10.0));
}

TEST(Rig, cameras_do_not_share_their_noise) {
  std::map<std::size_t, double> first_x;
  for (const Delivered& delivered : deliveries(twoCameras(), 1.0))
    first_x.emplace(delivered.camera, delivered.x);
  ASSERT_EQ(first_x.size(), 2u);
  EXPECT_NE(first_x[0], first_x[1]);  // both see the LED on their axis
}

TEST(Rig, a_moving_led_is_seen_where_it_was_at_the_exposure_not_at_the_delivery) {
  Description description = twoCameras();
  description.pixel_noise = 0.0;
  description.cameras.resize(1);
  description.cameras[0].timing = {0.01, 0.0, 0.2, 0.0};  // in transit for 0.2 s
  std::vector<double> x;
  Rig rig(description, pixelsTo(&x), kNoTruth);
  LedMotion& motion = rig.findLed("led")->motion;
  motion.line(0.0, Vector3d(0.0, -0.2, 1.0), 1.0);
  rig.runUntil(0.3001);
  ASSERT_EQ(x.size(), 11u);  // exposures 0.00 .. 0.10
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double y = motion.position(0.01 * static_cast<double>(i)).y();
    EXPECT_NEAR(x[i], 500.0 - 1300.0 * y / 3.0, 1e-6);
  }
  EXPECT_GT(x.back(), 540.0);
}

TEST(Rig, lost_frames_are_not_delivered_and_do_not_affect_others) {
  Description description = twoCameras();
  description.cameras.resize(1);
  description.cameras[0].timing.drops = 0.2;
  std::vector<double> x;
  Rig rig(description, pixelsTo(&x), kNoTruth);
  rig.runUntil(10.0);
  EXPECT_NEAR(static_cast<double>(x.size()), 800.0, 60.0);
  // The same noise on the same images as without losses.
  std::vector<double> all;
  description.cameras[0].timing.drops = 0.0;
  Rig complete(description, pixelsTo(&all), kNoTruth);
  complete.runUntil(10.0);
  std::size_t at = 0;
  for (double pixel : x) {
    at = static_cast<std::size_t>(std::find(all.begin() + at, all.end(), pixel) - all.begin());
    ASSERT_LT(at, all.size());
    ++at;
  }
}

TEST(Rig, publishes_the_truth_at_its_rate) {
  std::vector<double> times;
  std::vector<Vector3d> positions;
  Rig rig(
      twoCameras(), [](std::size_t, const virtual_wiimote::Senses&) {},
      [&](std::size_t led, double time, const Vector3d& position) {
        EXPECT_EQ(led, 0u);
        times.push_back(time);
        positions.push_back(position);
      });
  LedMotion& motion = rig.findLed("led")->motion;
  motion.line(0.0, Vector3d(1.0, 0.0, 1.0), 1.0);
  rig.runUntil(0.5);
  ASSERT_EQ(times.size(), 51u);
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_NEAR(times[i], 0.01 * static_cast<double>(i), 1e-12);
    EXPECT_LT((positions[i] - motion.position(times[i])).norm(), 1e-12);
  }
  EXPECT_NEAR(positions.back().x(), 0.5, 1e-12);
}

TEST(Rig, the_other_end_of_a_wand_stays_at_its_distance_and_turns) {
  Description description = twoCameras();
  LedDescription end;
  end.name = "end";
  end.turns = TurnDescription{"led", 0.4, 1.3};
  description.leds.push_back(end);
  std::vector<Vector3d> first, second;
  Rig rig(
      description, [](std::size_t, const virtual_wiimote::Senses&) {},
      [&](std::size_t led, double, const Vector3d& position) {
        (led == 0 ? first : second).push_back(position);
      });
  rig.findLed("led")->motion.wave(0.0, Vector3d(0, 0, 1), Vector3d::Ones(), 1.0, 1);
  rig.runUntil(10.0);
  ASSERT_EQ(first.size(), second.size());
  Vector3d low = Vector3d::Ones(), high = -Vector3d::Ones();
  for (std::size_t i = 0; i < first.size(); ++i) {
    const Vector3d wand = second[i] - first[i];
    EXPECT_NEAR(wand.norm(), 0.4, 1e-12);
    low = low.cwiseMin(wand);
    high = high.cwiseMax(wand);
  }
  EXPECT_GT((high - low).minCoeff(), 0.6) << "in 10 s it has pointed in all directions";
  rig.findLed("led")->motion.line(10.0, Vector3d(1.0, 2.0, 0.0), 0.0);
  rig.runUntil(11.0);
  EXPECT_EQ(second.back(), Vector3d(1.4, 2.0, 0.0)) << "on the floor it lies along x";
}

TEST(LedBoard, lights_rows_then_columns_four_at_a_time) {
  // The table of wiimote_tracker_calibration/doc/board.md, by hand: times, and the four LEDs.
  const std::vector<std::pair<double, std::vector<int>>> table = {
      {0.000, {0, 1, 2, 3}},     {0.060, {4, 5, 6, 7}},  {0.120, {8, 9, 10, 11}},
      {0.180, {12, 13, 14, 15}}, {0.240, {0, 4, 8, 12}}, {0.480, {1, 5, 9, 13}},
      {0.720, {2, 6, 10, 14}},   {0.960, {3, 7, 11, 15}}};
  geometry::Camera camera = cameraAt(Vector3d(0, 0, 1), Vector3d(5, 0, 1));
  BoardDescription description;
  description.column_spacing = 0.08;
  description.row_spacing = 0.1;
  LedBoard board(description, camera);
  std::vector<Lamp> lamps;
  board.addLamps(0.01, &lamps);
  EXPECT_TRUE(lamps.empty()) << "dark until it is switched on";
  board.setLit(true);
  std::map<int, Vector3d> all;
  for (const double cycle : {0.0, 5 * 1.98}) {
    for (const auto& [start, leds] : table) {
      for (const double after : {0.001, 0.039}) {
        lamps.clear();
        board.addLamps(cycle + start + after, &lamps);
        ASSERT_EQ(lamps.size(), 4u) << start;
        // The flash of a row and that of a column show an LED at the same place.
        for (int i = 0; i < 4; ++i)
          EXPECT_EQ(all.emplace(leds[i], lamps[i].position).first->second, lamps[i].position)
              << start << ": LED " << leds[i];
      }
      lamps.clear();
      board.addLamps(cycle + start + 0.041, &lamps);
      EXPECT_TRUE(lamps.empty()) << start;
    }
    for (const double dark : {0.301, 0.42, 1.03, 1.5, 1.97}) {
      lamps.clear();
      board.addLamps(cycle + dark, &lamps);
      EXPECT_TRUE(lamps.empty()) << dark;
    }
  }
  // A flat grid with the given spacings, as seen from the front.
  ASSERT_EQ(all.size(), 16u);
  EXPECT_NEAR((all[3] - all[0]).norm(), 0.24, 1e-12);
  EXPECT_NEAR((all[12] - all[0]).norm(), 0.3, 1e-12);
  EXPECT_LT((all[0] + all[15] - all[3] - all[12]).norm(), 1e-12);
  const Vector3d into = (all[3] - all[0]).cross(all[12] - all[0]);
  EXPECT_GT(into.dot(all[0] - camera.center()), 0.0);
}

TEST(LedBoard, is_in_view_in_nearly_every_pose_and_all_poses_differ) {
  const geometry::Camera camera = cameraAt(Vector3d(0, 0, 1), Vector3d(5, 0, 1));
  LedBoard board(BoardDescription(), camera);
  board.setLit(true);
  int seen = 0;
  std::vector<Vector3d> places;
  for (std::uint32_t pose = 0; pose < 50; ++pose) {
    board.show(pose);
    std::vector<Lamp> lamps;
    for (int row = 0; row < 4; ++row)
      board.addLamps(0.06 * row, &lamps);
    ASSERT_EQ(lamps.size(), 16u);
    for (const Lamp& lamp : lamps) {
      const auto pixel = camera.project(lamp.position);
      seen += pixel && pixel->x() > 0 && pixel->x() < 1023 && pixel->y() > 0 && pixel->y() < 767;
    }
    for (const Vector3d& place : places)
      EXPECT_GT((place - lamps[0].position).norm(), 1e-3);
    places.push_back(lamps[0].position);
  }
  EXPECT_GT(seen, 50 * 16 * 9 / 10);
}

TEST(Rig, a_dark_led_is_not_seen_but_images_go_on) {
  int images = 0, lights = 0;
  Rig rig(
      twoCameras(),
      [&](std::size_t, const virtual_wiimote::Senses& senses) {
        ++images;
        lights += static_cast<int>(senses.lights.size());
      },
      kNoTruth);
  rig.findLed("led")->lit = false;
  rig.runUntil(1.0);
  EXPECT_GT(images, 190);
  EXPECT_EQ(lights, 0);
  EXPECT_EQ(rig.findLed("lamp"), nullptr);
}

}  // namespace
}  // namespace wiimote_tracker::simulation
