#pragma once

#include "motion/modes.h"
#include "motion/pixel_prediction.h"
#include "wiimote_tracker_triangulation/geometry/camera.h"
#include "wiimote_tracker_triangulation/motion/motion_options.h"

#include <Eigen/Core>

#include <optional>

namespace wiimote_tracker::motion {

/// One LED's state in continuous time, updated by each camera's spot at that image's own time: an
/// interacting multiple model filter (Blom and Bar-Shalom 1988; Bar-Shalom, Li and Kirubarajan
/// 2001, section 11.6.6) over the modes of MotionOptions. The update is an extended Kalman
/// filter's, iterated where one linearisation is not accurate enough. A value: copies are
/// independent. Nothing here allocates.
///
/// The covariances are those for exact cameras. The error of the calibration is systematic and does
/// not average out, so its covariance is added to what is published.
class MotionFilter {
 public:
  /// From a triangulated point. @param options not owned. @param time [s], finite.
  /// @param position [m], finite. @param covariance [m^2], positive definite.
  MotionFilter(const MotionOptions& options,
               double time,
               const Eigen::Vector3d& position,
               const Eigen::Matrix3d& covariance);

  MotionFilter(const MotionOptions&&,
               double,
               const Eigen::Vector3d&,
               const Eigen::Matrix3d&) = delete;  // the filter would refer to a temporary

  double time() const { return time_; }  ///< [s]

  /// Predicts to a time [s]. Does nothing for a time that is not after time().
  void predict(double time);

  /// The LED's pixel at time(). Nothing when it is not in front of the camera (Camera::project).
  std::optional<PixelPrediction> predictPixel(const geometry::Camera& camera,
                                              const geometry::PixelNoise& noise) const;

  /// Updates with the pixel of the LED's spot at time(). The prediction must be this filter's in
  /// its present state. False, and nothing changes, when the pixel is not finite or more than
  /// 1e9 px away.
  bool update(const geometry::Camera& camera,
              const PixelPrediction& prediction,
              const Eigen::Vector2d& pixel);

  // Mean and covariance of the mixture of all modes.
  Eigen::Vector3d position() const { return mean(0); }                  ///< World [m].
  Eigen::Matrix3d positionCovariance() const { return covariance(0); }  ///< [m^2]
  Eigen::Vector3d velocity() const { return mean(3); }                  ///< World [m/s].
  Eigen::Matrix3d velocityCovariance() const { return covariance(3); }  ///< [m^2/s^2]

  const Modes& modes() const { return modes_; }

 private:
  bool linearize(const geometry::Camera& camera,
                 const Eigen::Vector3d& point,
                 PixelPrediction* prediction) const;
  bool isLinear(const geometry::Camera& camera,
                const PixelPrediction& prediction,
                const Eigen::Vector2d& pixel) const;
  std::optional<Eigen::Vector3d> rayIfAlone(const geometry::Camera& camera) const;
  void apply(const PixelPrediction& prediction,
             const Eigen::Vector2d& pixel,
             const std::optional<Eigen::Vector3d>& ray);
  void decayAlong(const Eigen::Vector3d& ray, double duration);
  Eigen::Vector3d mean(int first) const;
  Eigen::Matrix3d covariance(int first) const;

  const MotionOptions* options_;
  double time_;
  double last_stop_;                // last mixing into the modes at rest [s]
  double last_change_;              // last of the other mixings [s]
  double last_update_;              // [s]
  double last_change_of_camera_;    // last update by another camera than the one before [s]
  Eigen::Vector3d last_viewpoint_;  // center of the last camera [m]
  Modes modes_;
};

}  // namespace wiimote_tracker::motion
