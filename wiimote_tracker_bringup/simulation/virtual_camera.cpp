#include "virtual_camera.h"

#include <algorithm>

namespace wiimote_tracker::simulation {
namespace {

/// Rotation from the remote's axes (x left, y rear, z up) to the optical frame (x right, y down, z
/// forward).
Eigen::Matrix3d opticalFromImu() {
  Eigen::Matrix3d rotation;
  rotation.col(0) = -Eigen::Vector3d::UnitX();
  rotation.col(1) = -Eigen::Vector3d::UnitZ();
  rotation.col(2) = -Eigen::Vector3d::UnitY();
  return rotation;
}

}  // namespace

VirtualCamera::VirtualCamera(const geometry::Camera& camera, double pixel_noise, std::uint32_t seed)
    : camera_(camera), pixel_noise_(pixel_noise), random_(seed) {}

void VirtualCamera::lookAt(const Eigen::Vector3d& target) {
  camera_.world_from_camera = geometry::lookAt(camera_.center(), target, Eigen::Vector3d::UnitZ());
}

virtual_wiimote::Light VirtualCamera::lightAt(const Eigen::Vector2d& pixel,
                                              const Eigen::Vector2d& noise,
                                              const std::optional<double>& size,
                                              double brightness) const {
  virtual_wiimote::Light light;
  light.x = pixel.x() + noise.x();
  light.y = sensorY(camera_.intrinsics, pixel.y() + noise.y());
  light.size = size;
  light.brightness = brightness;
  return light;
}

virtual_wiimote::Senses VirtualCamera::sense(
    const std::vector<Lamp>& lamps,
    const std::vector<Cylinder>& bodies,
    const std::vector<ReflectionDescription>& reflections) {
  virtual_wiimote::Senses senses;
  // Specific force at rest in the remote's own axes [g].
  const Eigen::Vector3d up = opticalFromImu().transpose() *
                             camera_.world_from_camera.linear().transpose() *
                             Eigen::Vector3d::UnitZ();
  senses.acceleration = {up.x(), up.y(), up.z()};
  std::normal_distribution<double> normal;
  const auto draw = [&] {
    const double noise_u = pixel_noise_ * normal(random_);
    const double noise_v = pixel_noise_ * normal(random_);
    return Eigen::Vector2d(noise_u, noise_v);
  };
  for (const Lamp& lamp : lamps) {
    // Drawn for every lamp, visible or not, so that the noise of lamps is independent of the
    // others.
    const Eigen::Vector2d noise = draw();
    const auto pixel = camera_.project(lamp.position);
    if (!pixel || std::any_of(bodies.begin(), bodies.end(), [&](const Cylinder& body) {
          return body.hides(camera_.center(), lamp.position);
        }))
      continue;
    const double squared_distance = (lamp.position - camera_.center()).squaredNorm();
    senses.lights.push_back(
        lightAt(*pixel, noise, lamp.size,
                lamp.size ? lamp.brightness : lamp.brightness / squared_distance));
  }
  for (const ReflectionDescription& reflection : reflections) {
    if (reflection.lit && reflection.camera == camera_.name)
      senses.lights.push_back(
          lightAt(reflection.pixel, draw(), reflection.size, reflection.brightness));
  }
  return senses;
}

}  // namespace wiimote_tracker::simulation
