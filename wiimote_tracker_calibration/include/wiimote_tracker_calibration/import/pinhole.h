#pragma once

#include "wiimote_tracker_calibration/bundle/solve.h"
#include "wiimote_tracker_calibration/import/recording.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::import {

/// A projection matrix taken apart: P = scale * K [R | -R center], K upper triangular with positive
/// diagonal and K(2, 2) = 1, R a rotation.
struct Pinhole {
  double fx;    ///< [px]
  double fy;    ///< [px]
  double cx;    ///< [px]
  double cy;    ///< [px]
  double skew;  ///< K(0, 1) [px]
  Eigen::Isometry3d world_from_camera;
};

/// @throws ImportError naming `name` when the left 3x3 part is singular.
Pinhole takeApart(const ProjectionMatrix& projection, const std::string& name);

/// Turns pixels of a camera with a shipped projection matrix into those of a pinhole without
/// distortion and skew.
class Rectification {
 public:
  /// The image grows to the smallest one, by whole pixels, that holds the old image and all pixels
  /// of the camera at `index`.
  /// @param mirrored the matrix is for a mirror image of the world; z is then turned round.
  /// @throws ImportError: the recording has no projection matrix of it, or a singular one.
  Rectification(const Recording& recording, std::size_t index, bool mirrored);

  /// The pinhole.
  const geometry::Camera& camera() const { return camera_; }

  /// As the matrix has it, before the image grew.
  const Pinhole& pinhole() const { return pinhole_; }

  /// Nothing for a pixel that has no ray.
  std::optional<Eigen::Vector2d> operator()(const Eigen::Vector2d& pixel) const;

 private:
  geometry::Intrinsics lens_;
  Pinhole pinhole_;
  Eigen::Vector2d shift_ = Eigen::Vector2d::Zero();
  geometry::Camera camera_;
};

/// All cameras of the shipped projection matrices, the pixels of all frames as they see them, and
/// the points that they make. The matrices' world may be a mirror image (flydra's is); which it is
/// follows from where the light is in front of the cameras.
struct ShippedCameras {
  std::vector<Rectification> rectifications;
  std::vector<Pixels> frames;
  bundle::Reconstruction reconstruction;
};

/// @throws ImportError: no matrix, or none of them fits to the pixels.
ShippedCameras shippedCameras(const Recording& recording, const bundle::Options& options);

}  // namespace wiimote_tracker::import
