#ifndef WIIMOTE_TRACKER_BRINGUP_SIMULATION_VIRTUAL_CAMERA_H
#define WIIMOTE_TRACKER_BRINGUP_SIMULATION_VIRTUAL_CAMERA_H

#include "person.h"

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

/// A reflection that shines, where one camera sees it.
struct Glint {
  Eigen::Vector2d pixel;       ///< v down [px].
  std::optional<double> size;  ///< As of a Lamp [0..15].
  double brightness;           ///< As it reaches the camera.
};

/// The optics of one Wii Remote and the way it is mounted: from lamps in the world to what the
/// device senses. What the sensor itself does (rounding, edges, choice of four) is the device's.
class VirtualCamera {
 public:
  /// `pixel_noise`: standard deviation of each coordinate [px].
  VirtualCamera(const geometry::Camera& camera, double pixel_noise, std::uint32_t seed);

  /// Lights of the lamps before the camera that no body hides, and of its reflections, with noise;
  /// and gravity.
  virtual_wiimote::Senses sense(const std::vector<Lamp>& lamps,
                                const std::vector<Pillar>& bodies = {},
                                const std::vector<Glint>& glints = {});

 private:
  virtual_wiimote::Light lightAt(const Eigen::Vector2d& pixel,
                                 const Eigen::Vector2d& noise,
                                 const std::optional<double>& size,
                                 double brightness) const;

  geometry::Camera camera_;
  double pixel_noise_;
  std::mt19937 random_;
  Eigen::Vector3d acceleration_;  ///< Specific force at rest in the remote's own axes [g].
};

}  // namespace wiimote_tracker::simulation

#endif  // WIIMOTE_TRACKER_BRINGUP_SIMULATION_VIRTUAL_CAMERA_H
