#include "led_board.h"

#include <cmath>
#include <random>

namespace wiimote_tracker::simulation {
namespace {

constexpr int kSide = 4;
constexpr double kStep = 0.060;   // [s]
constexpr double kFlash = 0.040;  // [s]
constexpr int kSteps = 33;

bool isLit(int row, int column, double time) {
  const double in_cycle = std::fmod(time, kSteps * kStep);
  const int step = static_cast<int>(in_cycle / kStep);
  return in_cycle - step * kStep < kFlash && (step == row || step == kSide + kSide * column);
}

}  // namespace

LedBoard::LedBoard(const BoardDescription& description, const geometry::Camera& camera)
    : description_(description), world_from_camera_(camera.world_from_camera) {
  show(0);
}

void LedBoard::show(std::uint32_t pose) {
  std::mt19937 random(pose);
  const auto between = [&random](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  const double depth = between(0.55, 1.0);
  const double side = between(0.0, 2.0 * M_PI);
  const double tilt = between(0.35, 0.79);
  const double turn = between(-0.5, 0.5);
  const Eigen::Vector3d middle(between(-0.25, 0.25) * depth, between(-0.18, 0.18) * depth, depth);
  Eigen::Isometry3d camera_from_board = Eigen::Isometry3d::Identity();
  camera_from_board.linear() =
      (Eigen::AngleAxisd(tilt, Eigen::Vector3d(std::cos(side), std::sin(side), 0.0)) *
       Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()))
          .toRotationMatrix();
  const Eigen::Vector3d center(0.5 * (kSide - 1) * description_.column_spacing,
                               0.5 * (kSide - 1) * description_.row_spacing, 0.0);
  camera_from_board.translation() = middle - camera_from_board.linear() * center;
  world_from_board_ = world_from_camera_ * camera_from_board;
}

void LedBoard::addLamps(double time, std::vector<Lamp>* lamps) const {
  if (!lit_)
    return;
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      if (isLit(row, column, time))
        lamps->push_back({world_from_board_ * Eigen::Vector3d(column * description_.column_spacing,
                                                              row * description_.row_spacing, 0.0),
                          description_.size, 1.0});
    }
  }
}

}  // namespace wiimote_tracker::simulation
