#include "virtual_camera.h"

namespace wiimote_tracker::simulation {
namespace {

/// Rotation from the remote's own axes (x left, y rear, z up) to the optical frame (x right, y
/// down, z forward).
Eigen::Matrix3d opticalFromImu() {
  Eigen::Matrix3d rotation;
  rotation.col(0) = -Eigen::Vector3d::UnitX();
  rotation.col(1) = -Eigen::Vector3d::UnitZ();
  rotation.col(2) = -Eigen::Vector3d::UnitY();
  return rotation;
}

}  // namespace

VirtualCamera::VirtualCamera(const geometry::Camera& camera, double pixel_noise, std::uint32_t seed)
    : camera_(camera),
      pixel_noise_(pixel_noise),
      random_(seed),
      acceleration_(opticalFromImu().transpose() * camera.world_from_camera.linear().transpose() *
                    Eigen::Vector3d::UnitZ()) {}

virtual_wiimote::Senses VirtualCamera::sense(const std::vector<Lamp>& lamps) {
  virtual_wiimote::Senses senses;
  senses.acceleration = {acceleration_.x(), acceleration_.y(), acceleration_.z()};
  std::normal_distribution<double> normal;
  for (const Lamp& lamp : lamps) {
    // Drawn for every lamp, seen or not, so that one lamp's noise does not hang on another's place.
    const double noise_u = pixel_noise_ * normal(random_);
    const double noise_v = pixel_noise_ * normal(random_);
    const auto pixel = camera_.project(lamp.position);
    if (!pixel)
      continue;
    virtual_wiimote::Light light;
    light.x = pixel->x() + noise_u;
    light.y =
        camera_.intrinsics.height - 1 - (pixel->y() + noise_v);  // the sensor's y grows upwards
    light.size = lamp.size;
    light.brightness = lamp.brightness;
    if (!lamp.size)
      light.brightness /= (lamp.position - camera_.center()).squaredNorm();
    senses.lights.push_back(light);
  }
  return senses;
}

}  // namespace wiimote_tracker::simulation
