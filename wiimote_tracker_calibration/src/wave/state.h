#pragma once

#include "trajectory.h"
#include "wand_rest.h"

#include "wiimote_tracker_calibration/wave/recording.h"
#include "wiimote_tracker_calibration/wave/solve_wave.h"

#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <optional>
#include <set>
#include <vector>

namespace wiimote_tracker::wave {

/// Where each camera saw the two LEDs of a wand at rest, distorted [px]; nothing: it did not.
using FloorSpots = std::vector<std::optional<WandSpots>>;

/// What is solved.
struct Task {
  Recording recording;  ///< Of the wave, without lamps; stamps from its first image on.
  WaveOptions options;
  FloorSpots floor;  ///< Empty: no wand lay on the floor.
};

/// A wand that lay on the floor.
struct WandOnFloor {
  std::array<Eigen::Vector3d, 2> leds;  ///< World, that at the origin first [m].
  FloorSpots spots;                     ///< Each in the order of the LEDs.
};

/// Everything that is estimated.
struct State {
  std::vector<geometry::Camera> cameras;
  std::vector<double> offsets;  ///< exposure time = stamp + offset [s].
  Trajectory trajectory;
  bool z_up = true;                               ///< As in SquareLayout::corners(); not estimated.
  std::array<Eigen::Vector2d, 4> corner_offsets;  ///< Displacements from the layout [m].
  std::vector<Eigen::Vector3d> places;            ///< That are known: world, as estimated [m].
  Eigen::Vector2d shared_offset{0.0, 0.0};        ///< That all principal points have [px].
  double wand_length = 0.0;                       ///< [m]
  std::optional<WandOnFloor> floor;               ///< If it gives the world.
};

/// A spot associated with an LED.
struct Match {
  std::size_t camera;
  Eigen::Index led;
  Eigen::Index interval;  ///< Of the path's knots, in which it was exposed.
  double stamp;           ///< [s]
  Eigen::Vector2d pixel;
  Eigen::Matrix2d whitening;  ///< Of the pixel error [1/px].
};

/// The intervals of the path in which an LED was seen.
inline std::set<Eigen::Index> seenIntervals(const std::vector<Match>& matches) {
  std::set<Eigen::Index> intervals;
  for (const Match& match : matches)
    intervals.insert(match.interval);
  return intervals;
}

/// Moves cameras together; their rotations stay orthonormal.
inline void moveCameras(const Eigen::Isometry3d& to_from, std::vector<geometry::Camera>* cameras) {
  for (geometry::Camera& camera : *cameras) {
    Eigen::Isometry3d& pose = camera.world_from_camera;
    pose = to_from * pose;
    pose.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
  }
}

}  // namespace wiimote_tracker::wave
