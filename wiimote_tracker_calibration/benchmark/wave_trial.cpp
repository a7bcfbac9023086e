#include "wave_trial.h"

#include "wiimote_tracker_calibration/bundle/similarity.h"
#include "wiimote_tracker_calibration/square/solve_square.h"

#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/error.h>
#include <wiimote_tracker_triangulation/geometry/triangulate.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::wave {

namespace {

constexpr Eigen::Index kMessageSize = 16;
// 95 % of a normal distribution, and of chi squared with three degrees of freedom.
constexpr double kInterval = 1.959964;
constexpr double kRegion = 7.814728;

/// True minus estimated parameters of one camera, in the order of RigCalibration.msg.
Eigen::Matrix<double, kMessageSize, 1> difference(const geometry::Camera& truth,
                                                  double true_offset,
                                                  const geometry::RigCamera& estimate) {
  Eigen::Matrix<double, kMessageSize, 1> result = Eigen::Matrix<double, kMessageSize, 1>::Zero();
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(
      truth.world_from_camera.linear() * estimate.camera.world_from_camera.linear().transpose()));
  const geometry::Intrinsics& a = truth.intrinsics;
  const geometry::Intrinsics& b = estimate.camera.intrinsics;
  result.head<3>() = turn.angle() * turn.axis();
  result.segment<3>(3) = truth.center() - estimate.camera.center();
  result.segment<4>(6) << a.fx - b.fx, a.fy - b.fy, a.cx - b.cx, a.cy - b.cy;
  result(10) = a.distortion[0] - b.distortion[0];
  result(15) = true_offset - estimate.time_offset;
  return result;
}

/// Derivative of triangulated points by the cameras' parameters, numerically.
Eigen::MatrixXd pointsByParameters(const std::vector<geometry::Camera>& cameras,
                                   const std::vector<Eigen::Vector3d>& points) {
  Eigen::MatrixXd result =
      Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(points.size()),
                            kMessageSize * static_cast<Eigen::Index>(cameras.size()));
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    for (Eigen::Index k = 0; k <= 10; ++k) {
      const double step = k >= 6 && k < 10 ? 1e-2 : 1e-5;
      const auto moved = [&](double by) {
        std::vector<geometry::Camera> result = cameras;
        geometry::Camera& camera = result[i];
        geometry::Intrinsics& lens = camera.intrinsics;
        if (k < 3)
          camera.world_from_camera.linear() =
              Eigen::AngleAxisd(by, Eigen::Vector3d::Unit(k)) * camera.world_from_camera.linear();
        else if (k < 6)
          camera.world_from_camera.translation()[k - 3] += by;
        else
          *std::array<double*, 5>{&lens.fx, &lens.fy, &lens.cx, &lens.cy,
                                  &lens.distortion[0]}[static_cast<std::size_t>(k - 6)] += by;
        return pointErrors(cameras, result, points);
      };
      const Eigen::Matrix3Xd slope = (moved(step) - moved(-step)) / (2.0 * step);
      result.col(kMessageSize * static_cast<Eigen::Index>(i) + k) =
          Eigen::Map<const Eigen::VectorXd>(slope.data(), slope.size());
    }
  }
  return result;
}

void countCoverage(const std::vector<geometry::Camera>& truth,
                   const SimulatedWave& wave,
                   const WaveSolution& solution,
                   WaveTrial* trial) {
  const Eigen::MatrixXd& covariance = solution.rig.covariance;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const auto error = difference(truth[i], wave.offsets[i], solution.rig.cameras[i]);
    for (Eigen::Index k = 0; k < kMessageSize; ++k) {
      const Eigen::Index at = kMessageSize * static_cast<Eigen::Index>(i) + k;
      if (covariance(at, at) > 0.0)
        trial->intervals.count(std::abs(error(k)) < kInterval * std::sqrt(covariance(at, at)));
    }
  }
  std::vector<geometry::Camera> estimate;
  for (const geometry::RigCamera& camera : solution.rig.cameras)
    estimate.push_back(camera.camera);
  // Some points of the volume, in the solution's world.
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < solution.path.size(); i += solution.path.size() / 10)
    points.push_back(solution.path[i]);
  std::vector<Eigen::Vector3d> seen;
  for (const Eigen::Vector3d& point : points) {
    int views = 0;
    for (std::size_t i = 0; i < truth.size(); ++i)
      views += truth[i].sees(point) && estimate[i].sees(point) ? 1 : 0;
    if (views == static_cast<int>(truth.size()))
      seen.push_back(point);
  }
  if (seen.empty())
    return;
  const Eigen::Matrix3Xd errors = pointErrors(truth, estimate, seen);
  const Eigen::MatrixXd slopes = pointsByParameters(estimate, seen);
  for (std::size_t p = 0; p < seen.size(); ++p) {
    const auto rows = slopes.middleRows<3>(3 * static_cast<Eigen::Index>(p));
    const Eigen::Matrix3d region = rows * covariance * rows.transpose();
    const Eigen::Vector3d error = errors.col(static_cast<Eigen::Index>(p));
    trial->regions.count(error.dot(region.inverse() * error) < kRegion);
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
    // Least squares of a rigid motion turns as that of a similarity does.
    const Eigen::Matrix3d rotation = bundle::fitSimilarity(from, to).rotation;
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < kAlignment; ++i)
      shift += (to[i] - rotation * from[i]) / static_cast<double>(kAlignment);
    double sum = 0.0;
    for (std::size_t i = kAlignment; i < points_.size(); ++i)
      sum += (rotation * measured[i] + shift - points_[i]).squaredNorm();
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
    std::vector<geometry::Camera> cameras;
    for (const geometry::RigCamera& camera :
         square::solveSquare(*wave.recording.square, wave.recording.sightings(), square_options)
             .rig.cameras)
      cameras.push_back(camera.camera);
    return measurements.rms(cameras);
  } catch (const geometry::Error&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace

std::vector<Eigen::Vector3d> cubePoints(const std::vector<geometry::Camera>& truth) {
  std::vector<Eigen::Vector3d> points;
  const int kSteps = 6;
  for (int x = 0; x < kSteps; ++x) {
    for (int y = 0; y < kSteps; ++y) {
      for (int z = 0; z < kSteps; ++z) {
        const Eigen::Vector3d point = 2.5 / (kSteps - 1) * Eigen::Vector3d(x, y, z);
        if (std::all_of(truth.begin(), truth.end(),
                        [&](const geometry::Camera& camera) { return camera.sees(point); }))
          points.push_back(point);
      }
    }
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

WaveOptions optionsFor(const WaveScene& scene) {
  WaveOptions options;
  options.uncertainty = scene.uncertainty;
  options.stamp = scene.stamp;
  options.wander = scene.wander;
  return options;
}

namespace {

/// Without square and floor the cameras stand in the first, whose true place is known here.
Eigen::Isometry3d trueFromSolved(const WaveScene& scene,
                                 const SimulatedWave& wave,
                                 const WaveSolution& solution) {
  if (scene.square)
    return Eigen::Isometry3d::Identity();
  if (scene.rest > 0.0)
    return scene.cubeFromFloor();
  return wave.cameras.front().world_from_camera *
         solution.rig.cameras.front().camera.world_from_camera.inverse();
}

}  // namespace

std::vector<geometry::Camera> inTrueWorld(const WaveScene& scene,
                                          const SimulatedWave& wave,
                                          const WaveSolution& solution) {
  std::vector<geometry::Camera> cameras;
  for (const geometry::RigCamera& camera : solution.rig.cameras)
    cameras.push_back(camera.camera);
  const Eigen::Isometry3d move = trueFromSolved(scene, wave, solution);
  for (geometry::Camera& camera : cameras)
    camera.world_from_camera = move * camera.world_from_camera;
  return cameras;
}

WaveTrial runWaveTrial(const WaveScene& scene, std::uint64_t seed, bool with_positions) {
  const SimulatedWave wave = simulateWave(scene, seed);
  const WaveOptions options = optionsFor(scene);
  const std::vector<Eigen::Vector3d> points = cubePoints(wave.cameras);
  WaveTrial trial;
  WaveSolution solution;
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
  std::vector<geometry::Camera> truth = wave.cameras;
  for (geometry::Camera& camera : truth)
    camera.world_from_camera = solved_from_true * camera.world_from_camera;
  countCoverage(truth, wave, solution, &trial);
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
