#include "wiimote_tracker_calibration/simulation/simulated_wave.h"

#include <cmath>
#include <string>

namespace wiimote_tracker::wave {

namespace {

double uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

double normal(std::mt19937_64& random, double stddev) {
  return stddev > 0.0 ? std::normal_distribution<double>(0.0, stddev)(random) : 0.0;
}

bool inImage(const geometry::Intrinsics& lens, const Eigen::Vector2d& pixel) {
  return pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() < lens.width && pixel.y() < lens.height;
}

constexpr double kLifting = 1.0;  // Hands hide a wand that is lifted [s].
constexpr double kClock = 1.7e9;  // Stamps are as large as those of the system's clock.

/// What one more camera sees of the LED's path. `reference`: offset of the first camera's clock
/// [s].
void recordWave(const WaveScene& scene,
                std::size_t index,
                double offset,
                double reference,
                std::mt19937_64& random,
                SimulatedWave* wave) {
  const geometry::Camera& camera = wave->cameras[index];
  CameraRecording& recording = wave->recording.cameras[index];
  const geometry::Intrinsics& lens = camera.intrinsics;
  const int leds = scene.length > 0.0 ? 2 : 1;
  const auto anywhere = [&] {
    return Eigen::Vector2d(uniform(random, 0.0, lens.width - 1.0),
                           uniform(random, 0.0, lens.height - 1.0));
  };
  const Eigen::Vector2d lamp = anywhere();
  double wander = normal(random, scene.wander);
  const double period = (1.0 + normal(random, 1e-4)) / scene.rate;
  const double keep = std::exp(-period / 2.0);
  const double begin = scene.rest > 0.0 ? -kLifting - scene.rest : 0.0;
  for (double time = begin + uniform(random, 0.0, period); time < scene.duration; time += period) {
    wander = keep * wander + normal(random, scene.wander * std::sqrt(1.0 - keep * keep));
    Frame frame;
    frame.stamp = kClock + time - offset + wander + normal(random, scene.stamp);
    const bool rests = time < -kLifting;
    for (int led = 0; led < leds && (rests || time >= 0.0); ++led) {
      const auto pixel = camera.project(rests ? wave->floor[static_cast<std::size_t>(led)]
                                              : wave->path.position(time, led));
      if (!pixel || !inImage(lens, *pixel))
        continue;
      if (uniform(random, 0.0, 1.0) < scene.wrong_share) {
        frame.spots.push_back(anywhere());
        continue;
      }
      const Eigen::Vector2d noise(normal(random, scene.pixel), normal(random, scene.pixel));
      frame.spots.push_back(*pixel + noise);
      if (rests)
        continue;
      wave->views.push_back({index, led, kClock + time - reference, time});
    }
    if (scene.lamp)
      frame.spots.push_back(lamp + Eigen::Vector2d(normal(random, 0.4), normal(random, 0.4)));
    if (uniform(random, 0.0, 1.0) < scene.extra_share)
      frame.spots.push_back(anywhere());
    if (frame.spots.size() >= 2 && uniform(random, 0.0, 1.0) < 0.5)
      std::swap(frame.spots.front(), frame.spots.back());
    for (Eigen::Vector2d& spot : frame.spots) {
      if (scene.quantized)
        spot = spot.array().round();
    }
    // Stamps of a wandering clock stay in order.
    if (recording.frames.empty() || frame.stamp > recording.frames.back().stamp)
      recording.frames.push_back(frame);
  }
}

}  // namespace

SimulatedPath::SimulatedPath(double length, std::mt19937_64& random) : length_(length) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    rates_[axis] = {2.0 * M_PI * uniform(random, 0.12, 0.22),
                    2.0 * M_PI * uniform(random, 0.35, 0.6)};
    phases_[axis] = {uniform(random, 0.0, 2.0 * M_PI), uniform(random, 0.0, 2.0 * M_PI)};
  }
  turns_ = {2.0 * M_PI * uniform(random, 0.15, 0.3), 2.0 * M_PI * uniform(random, 0.15, 0.3),
            uniform(random, 0.0, 2.0 * M_PI), uniform(random, 0.0, 2.0 * M_PI)};
}

Eigen::Vector3d SimulatedPath::position(double time, int led) const {
  const double t = pace * time;
  Eigen::Vector3d point = center;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    point[axis] += reach[axis] * (0.65 * std::sin(rates_[a][0] * t + phases_[a][0]) +
                                  0.35 * std::sin(rates_[a][1] * t + phases_[a][1]));
  }
  const double azimuth = 2.5 * std::sin(turns_[0] * t + turns_[2]);
  const double elevation = 1.2 * std::sin(turns_[1] * t + turns_[3]);
  const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                                  std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  return point + (led == 0 ? 0.5 : -0.5) * length_ * direction;
}

Eigen::Vector3d SimulatedPath::velocity(double time, int led) const {
  const double kStep = 1e-5;
  return (position(time + kStep, led) - position(time - kStep, led)) / (2.0 * kStep);
}

square::Uncertainty WaveScene::wide() {
  square::Uncertainty uncertainty;
  uncertainty.focal = 0.04;
  uncertainty.principal_point = 20.0;
  uncertainty.shared_principal_point = 0.0;
  return uncertainty;
}

std::vector<Eigen::Isometry3d> WaveScene::poses() const {
  if (!cameras.empty())
    return cameras;
  // Fig. 1: cameras on the diagonals of the cube, 4.5 m from its edges, 2 m high, aimed a little
  // below its middle so that every corner is in view.
  std::vector<Eigen::Isometry3d> poses;
  const double distance = 4.5 + 1.25 * std::sqrt(2.0);
  for (std::size_t i = 0; i < camera_count; ++i) {
    const double angle = M_PI / 4.0 + static_cast<double>(i) * M_PI / 2.0;
    poses.push_back(geometry::lookAt(
        {1.25 + distance * std::cos(angle), 1.25 + distance * std::sin(angle), 2.0},
        {1.25, 1.25, 1.0}, Eigen::Vector3d::UnitZ()));
  }
  return poses;
}

Eigen::Isometry3d WaveScene::cubeFromFloor() const {
  const Eigen::Vector3d middle(1.25, 1.25, 0.0);
  Eigen::Vector3d x = middle - poses().front().translation();
  x = Eigen::Vector3d(x.x(), x.y(), 0.0).normalized();
  Eigen::Isometry3d cube_from_floor = Eigen::Isometry3d::Identity();
  cube_from_floor.linear() << x, Eigen::Vector3d::UnitZ().cross(x), Eigen::Vector3d::UnitZ();
  cube_from_floor.translation() = middle;
  return cube_from_floor;
}

namespace {

/// Lays the wand on a floor that is not quite even.
void layWand(const WaveScene& scene, std::mt19937_64& random, SimulatedWave* wave) {
  const double rise = normal(random, scene.uncertainty.placement);
  const double run = std::sqrt(scene.length * scene.length - rise * rise);
  wave->floor = {scene.cubeFromFloor() * Eigen::Vector3d::Zero(),
                 scene.cubeFromFloor() * Eigen::Vector3d(run, 0.0, rise)};
  wave->recording.wand->led_height = 0.0;
}

/// What an accelerometer reads whose direction is off [m/s^2].
Eigen::Vector3d readGravity(const geometry::Camera& camera,
                            double stddev,
                            std::mt19937_64& random) {
  const Eigen::Vector3d error(normal(random, stddev), normal(random, stddev),
                              normal(random, stddev));
  const Eigen::Vector3d up = camera.world_from_camera.linear().row(2);
  return 9.81 * (up + error - error.dot(up) * up).normalized();
}

}  // namespace

SimulatedWave simulateWave(const WaveScene& scene, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  SimulatedPath path(scene.length, random);
  return simulateWave(scene, path, random);
}

SimulatedWave simulateWave(const WaveScene& scene,
                           const SimulatedPath& path,
                           std::mt19937_64& random) {
  SimulatedWave result{{}, {}, {}, {}, path, {}, {}};
  if (scene.square) {
    square::SquareLayout layout;
    layout.side_x = scene.side;
    layout.side_y = scene.side;
    // The square lies in the middle of the cube's floor.
    layout.origin = Eigen::Vector2d::Constant(0.5 * scene.side - 1.25);
    result.recording.square = layout;
    result.corners = layout.corners(true);
    for (Eigen::Vector3d& corner : result.corners)
      corner += Eigen::Vector3d(normal(random, scene.uncertainty.placement),
                                normal(random, scene.uncertainty.placement), 0.0);
  }
  if (scene.length > 0.0)
    result.recording.wand = Wand{scene.length};
  if (scene.rest > 0.0)
    layWand(scene, random, &result);

  const double offset_stddev = scene.uncertainty.shared_principal_point;
  const double shared_x = normal(random, offset_stddev);
  const double shared_y = normal(random, offset_stddev);
  double reference = 0.0;
  for (const Eigen::Isometry3d& pose : scene.poses()) {
    const std::size_t index = result.cameras.size();
    CameraRecording recording;
    recording.sightings.name = "camera_" + std::to_string(index + 1);
    recording.clock_epoch = 7;
    geometry::Camera camera;
    camera.name = recording.sightings.name;
    camera.world_from_camera = pose;
    const square::Uncertainty& u = scene.uncertainty;
    const double scale = std::exp(normal(random, u.focal));
    const double aspect = std::exp(0.5 * normal(random, u.aspect));
    camera.intrinsics.fx *= scale * aspect;
    camera.intrinsics.fy *= scale / aspect;
    camera.intrinsics.cx += shared_x + normal(random, u.principal_point);
    camera.intrinsics.cy += shared_y + normal(random, u.principal_point);
    camera.intrinsics.distortion[0] += normal(random, u.k1);
    for (std::size_t c = 0; scene.square && c < 4; ++c)
      recording.sightings.corners[c] =
          camera.project(result.corners[c]).value() +
          Eigen::Vector2d(normal(random, u.pixel), normal(random, u.pixel));

    if (scene.rest > 0.0)
      recording.sightings.gravity = readGravity(camera, u.gravity, random);
    const double offset = uniform(random, -scene.offset, scene.offset);
    reference = index == 0 ? offset : reference;
    result.offsets.push_back(offset - reference);
    result.cameras.push_back(camera);
    result.recording.cameras.push_back(recording);
    recordWave(scene, index, offset, reference, random, &result);
  }
  return result;
}

SimulatedWave waveAgain(const WaveScene& scene, const SimulatedWave& before, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  SimulatedWave result = before;
  result.path = SimulatedPath(scene.length, random);
  result.views.clear();
  result.recording.wand.reset();
  if (scene.length > 0.0)
    result.recording.wand = Wand{scene.length};
  for (std::size_t i = 0; i < result.cameras.size(); ++i) {
    result.recording.cameras[i].frames.clear();
    recordWave(scene, i, before.offsets[i], 0.0, random, &result);
  }
  return result;
}

}  // namespace wiimote_tracker::wave
