#pragma once

#include "wiimote_tracker_calibration/bundle/reconstruction.h"

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::bundle {

/// Cameras on a ring around a room of 3 m, that look at its middle, and points in the room.
struct SyntheticRig {
  std::vector<geometry::Camera> cameras;
  std::vector<Eigen::Vector3d> points;
  std::vector<Observation> observations;

  SyntheticRig(std::size_t camera_count, std::size_t point_count, unsigned seed) : random(seed) {
    for (std::size_t i = 0; i < camera_count; ++i) {
      geometry::Camera camera;
      camera.name = "camera_" + std::to_string(i + 1);
      camera.intrinsics.width = 660;
      camera.intrinsics.height = 500;
      camera.intrinsics.fx = uniform(390.0, 430.0);
      camera.intrinsics.fy = uniform(390.0, 430.0);
      camera.intrinsics.cx = uniform(310.0, 350.0);
      camera.intrinsics.cy = uniform(230.0, 270.0);
      camera.intrinsics.distortion = {uniform(-0.29, -0.27), uniform(0.06, 0.08),
                                      uniform(-1e-3, 1e-3), uniform(-1e-3, 1e-3), 0.0};
      const double angle = 2.0 * M_PI * static_cast<double>(i) / static_cast<double>(camera_count) +
                           uniform(-0.2, 0.2);
      camera.world_from_camera =
          geometry::lookAt({4.0 * std::cos(angle), 4.0 * std::sin(angle), uniform(1.5, 2.5)},
                           {uniform(-0.3, 0.3), uniform(-0.3, 0.3), 1.0}, {0.0, 0.0, 1.0});
      cameras.push_back(camera);
    }
    for (std::size_t i = 0; i < point_count; ++i)
      points.emplace_back(uniform(-1.5, 1.5), uniform(-1.5, 1.5), uniform(0.0, 2.0));
    observe();
  }

  /// Makes the observations anew: every point in every camera that sees it.
  void observe() {
    observations.clear();
    for (std::size_t point = 0; point < points.size(); ++point) {
      for (std::size_t camera = 0; camera < cameras.size(); ++camera) {
        if (cameras[camera].sees(points[point]))
          observations.push_back({camera, point, *cameras[camera].project(points[point])});
      }
    }
  }

  void addNoise(double stddev_px) {
    std::normal_distribution<double> noise(0.0, stddev_px);
    for (Observation& observation : observations) {
      observation.pixel.x() += noise(random);
      observation.pixel.y() += noise(random);
    }
  }

  /// What a solver may know: the cameras' poses are nonsense.
  Reconstruction observed() const {
    Reconstruction result;
    result.cameras = cameras;
    result.observations = observations;
    result.points.resize(points.size());
    for (geometry::Camera& camera : result.cameras)
      camera.world_from_camera = Eigen::Isometry3d::Identity();
    return result;
  }

  /// The points that a solution determined, and their truth.
  std::pair<std::vector<Eigen::Vector3d>, std::vector<Eigen::Vector3d>> paired(
      const Reconstruction& solution) const {
    std::pair<std::vector<Eigen::Vector3d>, std::vector<Eigen::Vector3d>> result;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!solution.points[i])
        continue;
      result.first.push_back(*solution.points[i]);
      result.second.push_back(points[i]);
    }
    return result;
  }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  }

  std::mt19937 random;
};

}  // namespace wiimote_tracker::bundle
