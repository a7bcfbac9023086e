#ifndef WIIMOTE_TRACKER_BRINGUP_SIMULATION_VIRTUAL_CAMERA_H
#define WIIMOTE_TRACKER_BRINGUP_SIMULATION_VIRTUAL_CAMERA_H

#include "wiimote_tracker_driver/virtual_wiimote/device.h"
#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <random>
#include <vector>

namespace wiimote_tracker::simulation {

/// An LED that shines, at one instant.
struct Lamp {
  Eigen::Vector3d position;    ///< World [m].
  std::optional<double> size;  ///< As the sensor reports it [0..15].
  /// 1 is the Wii's sensor bar. With a size it is what reaches every camera, as if 1 m away;
  /// without one it falls with the square of the distance, and the size follows.
  double brightness;
};

/// The optics of one Wii Remote and the way it is mounted: from lamps in the world to what the
/// device senses. What the sensor itself does (rounding, edges, choice of four) is the device's.
class VirtualCamera {
 public:
  /// `pixel_noise`: standard deviation of each coordinate [px].
  VirtualCamera(const geometry::Camera& camera, double pixel_noise, std::uint32_t seed);

  /// Lights of the lamps before the camera, with noise, and gravity.
  virtual_wiimote::Senses sense(const std::vector<Lamp>& lamps);

 private:
  geometry::Camera camera_;
  double pixel_noise_;
  std::mt19937 random_;
  Eigen::Vector3d acceleration_;  ///< Specific force at rest in the remote's own axes [g].
};

}  // namespace wiimote_tracker::simulation

#endif  // WIIMOTE_TRACKER_BRINGUP_SIMULATION_VIRTUAL_CAMERA_H
