#pragma once

#include "carriers.h"

#include "wiimote_tracker_driver/virtual_wiimote/device.h"
#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <random>
#include <vector>

namespace wiimote_tracker::simulation {

/// A lit LED at one instant.
struct Lamp {
  Eigen::Vector3d position;    ///< World [m].
  std::optional<double> size;  ///< As reported by the sensor [0..15].
  /// 1 for the Wii's sensor bar. With a size: at every camera, as if 1 m away. Without a size it
  /// falls with the square of the distance and determines the size.
  double brightness;
};

/// The sensor's y, which points up, of the y in an image [px]: the inverse of what the driver does.
inline double sensorY(const geometry::Intrinsics& intrinsics, double y) {
  return intrinsics.height - 1 - y;
}

/// Optics and mounting of one Wii Remote: converts lamps in the world to the input of the device.
/// The device simulates the sensor (rounding, edges, the limit of four).
class VirtualCamera {
 public:
  /// `pixel_noise`: standard deviation of each coordinate [px].
  VirtualCamera(const geometry::Camera& camera, double pixel_noise, std::uint32_t seed);

  /// Turns it where it stands, as by a knock, so that its optical axis passes through a place [m].
  /// @throws geometry::InvalidRigError: the axis would be vertical.
  void lookAt(const Eigen::Vector3d& target);

  /// The lights of visible lamps and of the lit reflections in this camera, with noise; and
  /// gravity.
  virtual_wiimote::Senses sense(const std::vector<Lamp>& lamps,
                                const std::vector<Cylinder>& bodies = {},
                                const std::vector<ReflectionDescription>& reflections = {});

 private:
  virtual_wiimote::Light lightAt(const Eigen::Vector2d& pixel,
                                 const Eigen::Vector2d& noise,
                                 const std::optional<double>& size,
                                 double brightness) const;

  geometry::Camera camera_;
  double pixel_noise_;
  std::mt19937 random_;
};

}  // namespace wiimote_tracker::simulation
