#ifndef WIIMOTE_TRACKER_BRINGUP_SIMULATION_WAVE_PATH_H
#define WIIMOTE_TRACKER_BRINGUP_SIMULATION_WAVE_PATH_H

#include <Eigen/Core>

#include <cstdint>

namespace wiimote_tracker::simulation {

/// A smooth path of a hand that waves an LED through a box: two oscillations of incommensurable
/// periods per axis, so that laps do not repeat.
class WavePath {
 public:
  /// @param sides of the box [m, > 0], which contains the path. @param speed long-term RMS [m/s, >
  /// 0].
  /// @param seed selects the path.
  WavePath(const Eigen::Vector3d& middle,
           const Eigen::Vector3d& sides,
           double speed,
           std::uint32_t seed);

  /// @param time since the start of the wave [s]. @returns [m].
  Eigen::Vector3d position(double time) const;

 private:
  static constexpr int kParts = 2;
  static constexpr double kShare[kParts] = {0.7, 0.3};  ///< Of half a side; their sum is 1.

  Eigen::Vector3d middle_, half_sides_;
  Eigen::Matrix<double, 3, kParts> frequency_;  ///< [rad/s]
  Eigen::Matrix<double, 3, kParts> phase_;      ///< [rad]
};

}  // namespace wiimote_tracker::simulation

#endif  // WIIMOTE_TRACKER_BRINGUP_SIMULATION_WAVE_PATH_H
