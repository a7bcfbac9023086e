#pragma once

#include "wiimote_tracker_calibration/square/square_model.h"
#include "wiimote_tracker_calibration/wave/recording.h"

#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <random>
#include <vector>

namespace wiimote_tracker::wave {

/// An LED, or the two of a wand, moved smoothly through the cube [0, 2.5]^3 m.
class SimulatedPath {
 public:
  /// @param length 0: one LED.
  SimulatedPath(double length, std::mt19937_64& random);

  /// [m]; time [s].
  Eigen::Vector3d position(double time, int led) const;
  Eigen::Vector3d velocity(double time, int led) const;

  Eigen::Vector3d center = Eigen::Vector3d::Constant(1.25);   ///< [m]
  Eigen::Vector3d reach = Eigen::Vector3d(0.85, 0.85, 0.85);  ///< To each side [m].
  double pace = 1.0;                                          ///< Factor on the speed.

 private:
  double length_;
  std::array<std::array<double, 2>, 3> rates_;   // of two oscillations per axis [rad/s]
  std::array<std::array<double, 2>, 3> phases_;  // [rad]
  std::array<double, 4> turns_;                  // of the wand: rates and phases
};

/// What is simulated. The defaults are the paper's rig.
struct WaveScene {
  std::vector<Eigen::Isometry3d> cameras;  ///< Empty: the paper's.
  std::size_t camera_count = 4;            ///< Of the paper's.
  bool square = true;
  double side = 2.5;    ///< Of the square [m].
  double length = 0.0;  ///< Of the wand [m]; 0: one LED.
  double duration = 15.0;
  double pixel = 0.4;         ///< Noise before rounding, per axis [px].
  bool quantized = true;      ///< Whole pixels, as a Wii Remote reports.
  double wrong_share = 0.05;  ///< Of the LED's spots that are anywhere in the image instead.
  double extra_share = 0.0;   ///< Of the images that show one more spot, anywhere.
  bool lamp = false;          ///< Every image shows a lamp's spot, too.
  double offset = 0.010;      ///< Largest time offset to either side [s].
  double stamp = 0.0;         ///< Independent error of each stamp [s].
  double wander = 0.0;        ///< Error of the stamps [s], correlated over 2 s.
  double rate = 100.0;        ///< Of the images [Hz].
  /// For which a wand lies on the floor before it is lifted, hidden by hands for a second, and
  /// waved [s]; 0: it does not. Then every camera has an accelerometer.
  double rest = 0.0;
  /// Errors of lenses and corners are drawn from this.
  square::Uncertainty uncertainty = wide();

  /// Focal length off by 4 %, principal point of each camera by itself by 20 px.
  static square::Uncertainty wide();
  std::vector<Eigen::Isometry3d> poses() const;
  /// The world of a wand that lies in the middle of the cube's floor and points away from the first
  /// camera.
  Eigen::Isometry3d cubeFromFloor() const;
};

/// A recording and the truth behind it.
struct SimulatedWave {
  std::vector<geometry::Camera> cameras;
  std::vector<double> offsets;                      ///< Less the first camera's [s].
  square::Corners corners = square::zeroCorners();  ///< Where the LED really was put [m].
  /// LEDs of the wand on the floor, the origin first [m].
  std::array<Eigen::Vector3d, 2> floor = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  SimulatedPath path;
  /// Exposures at which a camera saw an LED where it was: for the bound.
  struct View {
    std::size_t camera;
    int led;
    double time;       ///< Of the exposure, by the first camera's clock [s].
    double path_time;  ///< The same on the path's own time [s].
  };
  std::vector<View> views;
  Recording recording;
};

SimulatedWave simulateWave(const WaveScene& scene, std::uint64_t seed);

/// Same with a path of one's own.
SimulatedWave simulateWave(const WaveScene& scene,
                           const SimulatedPath& path,
                           std::mt19937_64& random);

/// Another wave before the cameras of a session that was simulated before, with the same lenses,
/// time offsets and corners: `scene` says how it is waved and seen.
SimulatedWave waveAgain(const WaveScene& scene, const SimulatedWave& before, std::uint64_t seed);

}  // namespace wiimote_tracker::wave
