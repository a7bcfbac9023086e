#pragma once

#include "rooms/join_rooms.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>
#include <functional>
#include <random>
#include <vector>

namespace wiimote_tracker {

/// How somebody carries an LED through a door. The walk is not that of rooms/walker.h: heading
/// and speed wander, the hand sways with each step and drifts, and the walker steers for a goal
/// behind the door.
struct CarriedLed {
  double direction = 0.0;               ///< Of the walk, from the normal of the door [rad].
  double speed = 1.25;                  ///< [m/s]
  double hidden = 1.0;                  ///< Duration, around the door [s].
  double heading = 1.5 * M_PI / 180.0;  ///< Standard deviation of the heading [rad].
  double slowing = 0.0;                 ///< Share by which the walker is slower while hidden.
};

/// Two rooms with four cameras each on both sides of a door at the origin of the first world, each
/// calibrated for itself.
class TwoRooms {
 public:
  /// @param slope standard deviation of the tilt of the second world, about each horizontal axis
  /// [rad]
  TwoRooms(std::uint64_t seed, double slope);

  /// Carries an LED through the door and adds its two tracks.
  void carry(bool from_first, const CarriedLed& led);

  /// Ten times a day: any direction and speed, to and fro.
  void carryOften(int times, const CarriedLed& as = {});

  rooms::JoinedRooms join(const rooms::JoinOptions& options = {}) const;

  /// The true cameras of both rooms, in the first world.
  std::vector<geometry::RigCamera> trueCameras() const;

  /// True pose less the estimated one: rotation [rad], position of the middle of the second room's
  /// cameras [m].
  Eigen::Matrix<double, 6, 1> errorOf(const rooms::JoinedRooms& joined) const;

  geometry::Rig first;
  geometry::Rig second;
  std::vector<rooms::Path> first_tracks;
  std::vector<rooms::Path> second_tracks;
  std::vector<rooms::Path> walks;  ///< The LED's true positions in the first world, while seen.

 private:
  /// What the cameras of a rig measure of a true path, each in its world.
  rooms::Path measured(const geometry::Rig& rig,
                       const std::vector<geometry::RigCamera>& truth,
                       const rooms::Path& path);

  std::mt19937_64 random_;
  std::vector<geometry::RigCamera> first_truth_;
  std::vector<geometry::RigCamera> second_truth_;
  Eigen::Isometry3d first_from_second_;
  double time_ = 1.7e9;  // [s]
};

/// RMS errors of joined rooms over many simulated pairs, beside those that are stated.
struct RoomErrors {
  double position = 0.0;         ///< [m]
  double rotation = 0.0;         ///< [rad]
  double stated_position = 0.0;  ///< [m]
  double stated_rotation = 0.0;  ///< [rad]
  double nees = 0.0;             ///< Mean per parameter: 1 if the covariance is right.
};

/// @param carry carries the LED through the door of a pair. @param slope see TwoRooms [rad]
RoomErrors errorsOfRooms(int pairs,
                         const std::function<void(TwoRooms*)>& carry,
                         const rooms::JoinOptions& options = {},
                         double slope = rooms::JoinOptions().slope);

}  // namespace wiimote_tracker
