#include "led_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::simulation {
namespace {

using Eigen::Vector3d;

TEST(LedMotion, rests_until_it_is_moved) {
  const LedMotion motion(Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(motion.position(-1.0), Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(motion.position(100.0), Vector3d(1.0, 2.0, 3.0));
}

TEST(LedMotion, moves_on_a_line_at_the_given_mean_speed_and_stops) {
  LedMotion motion(Vector3d(0.0, 0.0, 0.0));
  const double arrival = motion.line(10.0, Vector3d(3.0, 4.0, 0.0), 2.0);
  EXPECT_DOUBLE_EQ(arrival, 12.5);  // 5 m at 2 m/s
  EXPECT_EQ(motion.position(10.0), Vector3d(0.0, 0.0, 0.0));
  EXPECT_LT((motion.position(11.25) - Vector3d(1.5, 2.0, 0.0)).norm(), 1e-12);
  EXPECT_EQ(motion.position(arrival), Vector3d(3.0, 4.0, 0.0));
  EXPECT_EQ(motion.position(1000.0), Vector3d(3.0, 4.0, 0.0));
}

TEST(LedMotion, starts_and_stops_as_softly_as_a_hand) {
  LedMotion motion(Vector3d::Zero());
  const double arrival = motion.line(10.0, Vector3d(2.0, 0.0, 0.0), 2.0);
  const double step = 1e-3;
  double fastest = 0.0, hardest = 0.0;
  for (double time = 9.9; time < arrival + 0.1; time += step) {
    const double before = motion.position(time - step).x();
    const double here = motion.position(time).x();
    const double after = motion.position(time + step).x();
    EXPECT_GE(after, here);
    fastest = std::max(fastest, (after - here) / step);
    hardest = std::max(hardest, std::abs(after - 2.0 * here + before) / (step * step));
  }
  // Of the minimum-jerk motion: 15/8 of the mean speed, and 10 / sqrt(3) distance / duration^2.
  EXPECT_NEAR(fastest, 3.75, 0.01);
  EXPECT_NEAR(hardest, 2.0 * 10.0 / std::sqrt(3.0), 0.1);
}

TEST(LedMotion, is_there_at_once_with_speed_zero) {
  LedMotion motion(Vector3d(1.0, 0.0, 0.0));
  EXPECT_EQ(motion.line(5.0, Vector3d(0.0, 1.0, 0.0), 0.0), 5.0);
  EXPECT_EQ(motion.position(4.999), Vector3d(1.0, 0.0, 0.0));
  EXPECT_EQ(motion.position(5.0), Vector3d(0.0, 1.0, 0.0));
}

TEST(LedMotion, holds_in_the_middle_of_a_line) {
  LedMotion motion(Vector3d(0.0, 0.0, 0.0));
  motion.line(0.0, Vector3d(1.0, 0.0, 0.0), 1.0);
  motion.hold(0.5);
  EXPECT_LT((motion.position(0.9) - Vector3d(0.5, 0.0, 0.0)).norm(), 1e-12);
}

TEST(LedMotion, a_new_line_begins_at_the_present_position) {
  LedMotion motion(Vector3d(0.0, 0.0, 0.0));
  motion.line(0.0, Vector3d(1.0, 0.0, 0.0), 1.0);
  const double arrival = motion.line(0.5, Vector3d(0.5, 2.0, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(arrival, 2.5);
  EXPECT_LT((motion.position(1.5) - Vector3d(0.5, 1.0, 0.0)).norm(), 1e-12);
}

TEST(LedMotion, circles_counter_clockwise_from_the_x_side_at_constant_speed) {
  LedMotion motion(Vector3d(1.0, 1.0, 0.5));
  const Vector3d center(1.0, 1.0, 0.5);
  const double arrival = motion.circle(2.0, center, 0.75, 1.5);
  EXPECT_DOUBLE_EQ(arrival, 2.5);  // 0.75 m to the +x side at 1.5 m/s
  const double lap = 2.0 * M_PI * 0.75 / 1.5;
  EXPECT_LT((motion.position(arrival) - (center + Vector3d(0.75, 0.0, 0.0))).norm(), 1e-12);
  EXPECT_LT((motion.position(arrival + lap / 4) - (center + Vector3d(0.0, 0.75, 0.0))).norm(),
            1e-12);
  EXPECT_LT((motion.position(arrival + lap / 2) - (center - Vector3d(0.75, 0.0, 0.0))).norm(),
            1e-12);
  EXPECT_LT((motion.position(arrival + 7 * lap) - (center + Vector3d(0.75, 0.0, 0.0))).norm(),
            1e-9);
  // Leaving the circle starts from the circle.
  const Vector3d left = motion.position(arrival + lap / 3);
  motion.line(arrival + lap / 3, Vector3d::Zero(), 1.0);
  EXPECT_LT((motion.position(arrival + lap / 3) - left).norm(), 1e-12);
}

TEST(LedMotion, is_waved_smoothly_inside_its_box_at_the_given_speed) {
  const Vector3d middle(1.0, 1.0, 1.2), sides(2.0, 1.6, 0.8);
  LedMotion motion(Vector3d(1.0, 1.0, 0.0));
  const double arrival = motion.wave(3.0, middle, sides, 1.3, 7);
  EXPECT_GT(arrival, 3.0);
  const double step = 0.002;
  double sum_of_squares = 0.0, fastest = 0.0;
  Vector3d low = middle, high = middle;
  const int steps = 100000;  // 200 s
  for (int i = 0; i < steps; ++i) {
    const double time = arrival + step * i;
    const Vector3d here = motion.position(time);
    const Vector3d velocity = (motion.position(time + step) - here) / step;
    const Vector3d next = (motion.position(time + 2 * step) - motion.position(time + step)) / step;
    sum_of_squares += velocity.squaredNorm();
    fastest = std::max(fastest, (next - velocity).norm() / step);
    low = low.cwiseMin(here);
    high = high.cwiseMax(here);
  }
  EXPECT_NEAR(std::sqrt(sum_of_squares / steps), 1.3, 0.065);
  EXPECT_LT(fastest, 12.0) << "m/s^2: the limit of a hand";
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_GE(low(axis), middle(axis) - sides(axis) / 2);
    EXPECT_LE(high(axis), middle(axis) + sides(axis) / 2);
    EXPECT_GT(high(axis) - low(axis), 0.95 * sides(axis)) << "it fills the box";
  }
}

TEST(LedMotion, the_same_wave_is_the_same_path_and_another_one_is_not) {
  const auto place = [](std::uint32_t path) {
    LedMotion motion(Vector3d::Zero());
    const double arrival = motion.wave(0.0, Vector3d::Zero(), Vector3d::Ones(), 1.0, path);
    return motion.position(arrival + 5.0);
  };
  EXPECT_EQ(place(1), place(1));
  EXPECT_GT((place(1) - place(2)).norm(), 1e-3);
}

TEST(LedMotion, a_wave_begins_where_the_way_to_it_ends_and_can_be_held) {
  LedMotion motion(Vector3d(0.0, 0.0, 0.0));
  const double arrival = motion.wave(1.0, Vector3d(2.0, 0.0, 1.0), Vector3d::Ones(), 2.0, 3);
  EXPECT_LT((motion.position(arrival - 1e-6) - motion.position(arrival + 1e-6)).norm(), 1e-5);
  const Vector3d held = motion.position(arrival + 2.0);
  motion.hold(arrival + 2.0);
  EXPECT_EQ(motion.position(arrival + 9.0), held);
}

/// A roof: up in 1 s, down in 3 s, in decimetres, starting at 5 s.
Drawing roof(double size, double rest) {
  return Drawing({{5.0, {7.0, 0.0, 0.0}}, {6.0, {9.0, 0.0, 1.0}}, {9.0, {11.0, 0.0, 0.0}}}, size,
                 rest);
}

TEST(LedMotion, draws_in_its_box_after_a_rest_and_stays_at_the_end) {
  LedMotion motion(Vector3d(0.0, 0.0, 1.0));
  const Vector3d middle(1.0, 2.0, 1.0);
  // The longest side is 0.8 m, hence the other one 0.2 m; the beginning is (0.6, 2, 0.9).
  const double begin = motion.draw(10.0, roof(0.8, 0.5), middle, 2.0);
  const double way = Vector3d(0.6, 2.0, -0.1).norm();
  EXPECT_DOUBLE_EQ(begin, 10.0 + way / 2.0 + 0.5);
  EXPECT_EQ(motion.position(10.0), Vector3d(0.0, 0.0, 1.0));
  EXPECT_LT((motion.position(begin - 0.49) - Vector3d(0.6, 2.0, 0.9)).norm(), 1e-12);
  EXPECT_LT((motion.position(begin) - Vector3d(0.6, 2.0, 0.9)).norm(), 1e-12);
  EXPECT_LT((motion.position(begin + 0.5) - Vector3d(0.8, 2.0, 1.0)).norm(), 1e-12);
  EXPECT_LT((motion.position(begin + 1.0) - Vector3d(1.0, 2.0, 1.1)).norm(), 1e-12);
  EXPECT_LT((motion.position(begin + 2.5) - Vector3d(1.2, 2.0, 1.0)).norm(), 1e-12);
  EXPECT_LT((motion.position(begin + 50.0) - Vector3d(1.4, 2.0, 0.9)).norm(), 1e-12);
  EXPECT_FALSE(motion.isDrawing(begin - 0.01));
  EXPECT_TRUE(motion.isDrawing(begin + 0.01));
  EXPECT_TRUE(motion.isDrawing(begin + 3.99));
  EXPECT_FALSE(motion.isDrawing(begin + 4.01));
  motion.hold(begin + 0.5);
  EXPECT_FALSE(motion.isDrawing(begin + 0.6));
  EXPECT_LT((motion.position(begin + 9.0) - Vector3d(0.8, 2.0, 1.0)).norm(), 1e-12);
}

}  // namespace
}  // namespace wiimote_tracker::simulation
