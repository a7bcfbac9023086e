#pragma once

#include "description.h"

#include "wiimote_tracker_calibration/simulation/simulated_wave.h"
#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace wiimote_tracker::monte_carlo {

/// A still LED: its nominal and its true position, and the mean of its pixels in each camera that
/// saw it.
struct StillLed {
  Eigen::Vector3d nominal;  ///< [m]
  Eigen::Vector3d truth;    ///< [m]
  std::vector<std::optional<Eigen::Vector2d>> pixels;
};

/// A measurement session of the paper (section V.B) with the cameras of a description, and all that
/// this project could have recorded in it. Deviations of the lenses from the paper's K (2), and of
/// the corners from their nominal positions, are those of square::Uncertainty, but each principal
/// point is off by 15 px by itself.
struct PaperSession {
  wave::WaveScene wave_scene;
  wave::SimulatedWave wave;  ///< True cameras, the corners' sightings, a waved LED.
  wave::WaveScene wand_scene;
  wave::SimulatedWave wand;  ///< The same cameras and corners, a waved wand.
  /// Per camera, from 12 views of the board, without distortion: the paper's C2.
  std::vector<geometry::Intrinsics> board_lenses;
  std::vector<StillLed> points;        ///< The paper's ten points.
  std::vector<StillLed> known_places;  ///< 27 in the whole cube, for a volume correction.
};

/// Standard deviation of a coordinate of StillLed::pixels [px].
double stillPixelStddev(const simulation::Description& description);

/// @param cameras of the description. Lenses are drawn until each camera sees every point of the
/// experiment that it sees in the description, as if people had aimed the cameras.
/// @throws std::runtime_error: no such lenses are found.
PaperSession drawPaperSession(const simulation::Description& description,
                              const std::vector<std::size_t>& cameras,
                              std::uint32_t seed);

}  // namespace wiimote_tracker::monte_carlo
