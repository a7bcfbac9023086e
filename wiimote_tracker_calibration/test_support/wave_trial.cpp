#include "wave_trial.h"

#include "simulated_square.h"
#include "wiimote_tracker_calibration/square/solve_square.h"

#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/error.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/point_sensitivity.h>
#include <wiimote_tracker_triangulation/geometry/triangulate.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::wave {

namespace {

// 95 % of a normal distribution, and of chi squared with three degrees of freedom.
constexpr double kInterval = 1.959964;
constexpr double kRegion = 7.814728;

bool allSee(const std::vector<geometry::Camera>& cameras, const Eigen::Vector3d& point) {
  return std::all_of(cameras.begin(), cameras.end(),
                     [&](const geometry::Camera& camera) { return camera.sees(point); });
}

std::vector<geometry::Camera> movedBy(std::vector<geometry::Camera> cameras,
                                      const Eigen::Isometry3d& by) {
  for (geometry::Camera& camera : cameras)
    camera.world_from_camera = by * camera.world_from_camera;
  return cameras;
}

/// Without square and floor the cameras stand in the first, whose true place is known here.
Eigen::Isometry3d trueFromSolved(const WaveScene& scene,
                                 const SimulatedWave& wave,
                                 const square::Solution& solution) {
  if (scene.square)
    return Eigen::Isometry3d::Identity();
  if (scene.rest > 0.0)
    return scene.cubeFromFloor();
  return wave.cameras.front().world_from_camera *
         solution.rig.cameras.front().camera.world_from_camera.inverse();
}

void countCoverage(const std::vector<geometry::Camera>& truth,
                   const SimulatedWave& wave,
                   const square::Solution& solution,
                   WaveTrial* trial) {
  const Eigen::MatrixXd& covariance = solution.rig.covariance;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const geometry::RigCamera& estimate = solution.rig.cameras[i];
    auto error = square::parameterDifference(estimate.camera, truth[i]);
    error[geometry::kTimeOffset] = wave.offsets[i] - estimate.time_offset;
    for (Eigen::Index k = 0; k < error.size(); ++k) {
      const Eigen::Index at = geometry::firstParameter(i) + k;
      if (covariance(at, at) > 0.0)
        trial->intervals.count(std::abs(error(k)) < kInterval * std::sqrt(covariance(at, at)));
    }
  }
  const std::vector<geometry::Camera> estimate = camerasOf(solution.rig.cameras);
  // Some points of the volume, in the solution's world.
  for (std::size_t p = 0; p < solution.path.size(); p += solution.path.size() / 10) {
    const Eigen::Vector3d& point = solution.path[p];
    const std::vector<std::size_t> seeing = geometry::camerasSeeing(solution.rig, point);
    if (seeing.size() < truth.size() || !allSee(truth, point))
      continue;
    const Eigen::Vector3d error = pointErrors(truth, estimate, {point});
    const Eigen::MatrixXd by_parameters =
        geometry::pointByParameters(solution.rig, point, seeing).value();
    trial->regions.count(geometry::squaredMahalanobis(
                             error, geometry::propagated(by_parameters, covariance)) < kRegion);
  }
}

/// RMS of single measurements in the cube, aligned on 500 of them, counted on 1000 others.
class Measurements {
 public:
  Measurements(const WaveScene& scene,
               const std::vector<geometry::Camera>& truth,
               std::mt19937_64& random) {
    std::uniform_real_distribution<double> place(0.0, 2.5);
    std::normal_distribution<double> noise(0.0, scene.pixel);
    while (points_.size() < kAlignment + 1000) {
      const Eigen::Vector3d point(place(random), place(random), place(random));
      std::vector<Eigen::Vector2d> pixels;
      bool everywhere = true;
      for (const geometry::Camera& camera : truth) {
        everywhere = everywhere && camera.sees(point);
        if (!everywhere)
          break;
        const Eigen::Vector2d pixel =
            *camera.project(point) + Eigen::Vector2d(noise(random), noise(random));
        pixels.push_back(scene.quantized ? Eigen::Vector2d(pixel.array().round()) : pixel);
      }
      if (!everywhere)
        continue;
      points_.push_back(point);
      pixels_.push_back(pixels);
    }
  }

  double rms(const std::vector<geometry::Camera>& cameras) const {
    std::vector<Eigen::Vector3d> measured;
    for (const std::vector<Eigen::Vector2d>& pixels : pixels_) {
      std::vector<geometry::Observation> observations;
      for (std::size_t i = 0; i < cameras.size(); ++i)
        observations.push_back({&cameras[i], pixels[i]});
      const auto point = geometry::triangulate(observations, geometry::TriangulationOptions());
      if (!point)
        return std::numeric_limits<double>::quiet_NaN();
      measured.push_back(point->position);
    }
    const std::vector<Eigen::Vector3d> from(measured.begin(), measured.begin() + kAlignment);
    const std::vector<Eigen::Vector3d> to(points_.begin(), points_.begin() + kAlignment);
    const Eigen::Isometry3d to_from = geometry::rigidAlignment(to, from);
    double sum = 0.0;
    for (std::size_t i = kAlignment; i < points_.size(); ++i)
      sum += (to_from * measured[i] - points_[i]).squaredNorm();
    return std::sqrt(sum / static_cast<double>(points_.size() - kAlignment));
  }

 private:
  static constexpr std::ptrdiff_t kAlignment = 500;
  std::vector<Eigen::Vector3d> points_;
  std::vector<std::vector<Eigen::Vector2d>> pixels_;
};

double squareAlone(const SimulatedWave& wave,
                   const WaveOptions& options,
                   const Measurements& measurements) {
  if (!wave.recording.square)
    return std::numeric_limits<double>::quiet_NaN();
  square::SolveOptions square_options;
  square_options.uncertainty = options.uncertainty;
  try {
    const auto solution =
        square::solveSquare(*wave.recording.square, wave.recording.sightings(), square_options);
    return measurements.rms(camerasOf(solution.rig.cameras));
  } catch (const geometry::Error&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace

std::vector<geometry::Camera> camerasOf(const std::vector<geometry::RigCamera>& cameras) {
  std::vector<geometry::Camera> result;
  result.reserve(cameras.size());
  for (const geometry::RigCamera& camera : cameras)
    result.push_back(camera.camera);
  return result;
}

std::vector<Eigen::Vector3d> cubePoints(const std::vector<geometry::Camera>& truth) {
  std::vector<Eigen::Vector3d> points;
  constexpr int kSteps = 6;
  for (int i = 0; i < kSteps * kSteps * kSteps; ++i) {
    const Eigen::Vector3i cell(i / kSteps / kSteps, i / kSteps % kSteps, i % kSteps);
    const Eigen::Vector3d point = 2.5 / (kSteps - 1) * cell.cast<double>();
    if (allSee(truth, point))
      points.push_back(point);
  }
  return points;
}

Eigen::Matrix3Xd pointErrors(const std::vector<geometry::Camera>& truth,
                             const std::vector<geometry::Camera>& estimate,
                             const std::vector<Eigen::Vector3d>& points) {
  Eigen::Matrix3Xd errors(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t p = 0; p < points.size(); ++p) {
    std::vector<geometry::Observation> observations;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (truth[i].sees(points[p]))
        observations.push_back({&estimate[i], *truth[i].project(points[p])});
    }
    const auto point = geometry::triangulate(observations, geometry::TriangulationOptions());
    errors.col(static_cast<Eigen::Index>(p)) =
        point ? Eigen::Vector3d(point->position - points[p])
              : Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  }
  return errors;
}

double volumeError(const std::vector<geometry::RigCamera>& truth, const geometry::Rig& rig) {
  const std::vector<geometry::Camera> cameras = camerasOf(truth);
  const Eigen::Matrix3Xd errors = pointErrors(cameras, camerasOf(rig.cameras), cubePoints(cameras));
  return std::sqrt(errors.colwise().squaredNorm().mean());
}

WaveOptions optionsFor(const WaveScene& scene) {
  WaveOptions options;
  options.uncertainty = scene.uncertainty;
  options.stamp = scene.stamp;
  options.wander = scene.wander;
  return options;
}

std::vector<geometry::Camera> inTrueWorld(const WaveScene& scene,
                                          const SimulatedWave& wave,
                                          const square::Solution& solution) {
  return movedBy(camerasOf(solution.rig.cameras), trueFromSolved(scene, wave, solution));
}

WaveTrial runWaveTrial(const WaveScene& scene, std::uint64_t seed, bool with_positions) {
  const SimulatedWave wave = simulateWave(scene, seed);
  const WaveOptions options = optionsFor(scene);
  const std::vector<Eigen::Vector3d> points = cubePoints(wave.cameras);
  WaveTrial trial;
  square::Solution solution;
  try {
    solution = solveWave(wave.recording, options);
  } catch (const geometry::Error& error) {
    trial.refusal = error.what();
    return trial;
  }

  const double pixel = std::sqrt(scene.pixel * scene.pixel + (scene.quantized ? 1.0 / 12.0 : 0.0));
  const WaveBound bound = waveBound(scene, wave, pixel, points);
  const std::vector<geometry::Camera> estimate = inTrueWorld(scene, wave, solution);
  trial.error = volumeError(pointErrors(wave.cameras, estimate, points), points);
  trial.bound = bound.volume;
  for (std::size_t i = 1; i < wave.cameras.size(); ++i) {
    trial.offset_errors.push_back(solution.rig.cameras[i].time_offset - wave.offsets[i]);
    const Eigen::Index at = 12 * static_cast<Eigen::Index>(i) + 11;
    trial.offset_bounds.push_back(std::sqrt(bound.covariance(at, at)));
    const Eigen::Index clock = geometry::firstParameter(i) + geometry::kTimeOffset;
    trial.offset_stddevs.push_back(std::sqrt(solution.rig.covariance(clock, clock)));
  }
  const Eigen::Isometry3d solved_from_true = trueFromSolved(scene, wave, solution).inverse();
  countCoverage(movedBy(wave.cameras, solved_from_true), wave, solution, &trial);
  if (scene.length > 0.0) {
    // Sticks of the wand's length in the cube, as the solved cameras measure them.
    double sum = 0.0;
    int count = 0;
    for (int i = 0; i < 200; ++i) {
      const double time = scene.duration * (i + 0.5) / 200.0;
      const std::vector<Eigen::Vector3d> ends = {wave.path.position(time, 0),
                                                 wave.path.position(time, 1)};
      const Eigen::Matrix3Xd errors = pointErrors(wave.cameras, estimate, ends);
      const double length = (ends[0] + errors.col(0) - ends[1] - errors.col(1)).norm();
      if (!std::isfinite(length))
        continue;
      sum += length / scene.length - 1.0;
      ++count;
    }
    trial.length_error = sum / count;
  }
  if (with_positions) {
    std::mt19937_64 random(seed + 1000003);
    const Measurements measurements(scene, wave.cameras, random);
    trial.position.solved = measurements.rms(estimate);
    trial.position.perfect = measurements.rms(wave.cameras);
    trial.position.square = squareAlone(wave, options, measurements);
  }
  return trial;
}

}  // namespace wiimote_tracker::wave
