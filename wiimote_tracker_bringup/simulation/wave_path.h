#ifndef WIIMOTE_TRACKER_BRINGUP_SIMULATION_WAVE_PATH_H
#define WIIMOTE_TRACKER_BRINGUP_SIMULATION_WAVE_PATH_H

#include <Eigen/Core>

#include <cstdint>

namespace wiimote_tracker::simulation {

/// How a hand waves an LED through a box: along each axis two oscillations whose periods have no
/// common multiple, so that no lap is like another. Smooth, and a function of time alone.
class WavePath {
 public:
  WavePath() = default;

  /// @param sides of the box [m, > 0]; the path never leaves it. @param speed root mean square
  /// over a long time [m/s, > 0]. @param seed another path for each.
  WavePath(const Eigen::Vector3d& middle,
           const Eigen::Vector3d& sides,
           double speed,
           std::uint32_t seed);

  /// @param time since the beginning of the wave [s]. @returns [m]
  Eigen::Vector3d position(double time) const;

 private:
  static constexpr int kParts = 2;
  static constexpr double kShare[kParts] = {0.7, 0.3};  ///< Of half a side; together 1.

  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d half_sides_ = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 3, kParts> frequency_ =
      Eigen::Matrix<double, 3, kParts>::Zero();                                        ///< [rad/s]
  Eigen::Matrix<double, 3, kParts> phase_ = Eigen::Matrix<double, 3, kParts>::Zero();  ///< [rad]
};

}  // namespace wiimote_tracker::simulation

#endif  // WIIMOTE_TRACKER_BRINGUP_SIMULATION_WAVE_PATH_H
