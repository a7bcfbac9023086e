#ifndef WIIMOTE_TRACKER_TRIANGULATION_MOTION_MOTION_FILTER_H
#define WIIMOTE_TRACKER_TRIANGULATION_MOTION_MOTION_FILTER_H

#include "wiimote_tracker_triangulation/geometry/camera.h"
#include "wiimote_tracker_triangulation/motion/kinematic_states.h"
#include "wiimote_tracker_triangulation/motion/motion_options.h"
#include "wiimote_tracker_triangulation/motion/motion_steps.h"
#include "wiimote_tracker_triangulation/motion/pixel_prediction.h"
#include "wiimote_tracker_triangulation/motion/resting_states.h"

#include <Eigen/Core>

#include <optional>

namespace wiimote_tracker::motion {

/// One LED's state in continuous time, updated by each camera's spot at that image's own time: an
/// interacting multiple model filter (Blom and Bar-Shalom 1988) over the six ways of
/// MotionOptions, linearised at the prediction, and again at the result where that is not close
/// enough. A value: copies are independent. Nothing here allocates.
///
/// The covariances are of exact cameras: what the calibration adds is systematic, not averaged out
/// by more images, and belongs added to what is published.
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
               const Eigen::Matrix3d&) = delete;  // a temporary would be gone

  double time() const { return time_; }  ///< [s]

  /// Goes on to a time [s]; one that is not after time() changes nothing.
  void predict(double time);

  /// The same, where many LEDs go on by the same duration. @param steps of this filter's options
  void predict(double time, MotionSteps* steps);

  /// At time(). Nothing when the LED is not before the camera (see Camera::project).
  std::optional<PixelPrediction> predictPixel(const geometry::Camera& camera,
                                              const PixelNoise& noise) const;

  /// Takes in the pixel of the LED's spot at time(). The prediction must be this filter's as it is.
  /// False, and nothing changes, when the pixel is not finite or absurdly far away (1e9 px).
  bool update(const geometry::Camera& camera,
              const PixelPrediction& prediction,
              const Eigen::Vector2d& pixel);

  Eigen::Vector3d position() const;            ///< Mean, world [m].
  Eigen::Matrix3d positionCovariance() const;  ///< [m^2]
  Eigen::Vector3d velocity() const;            ///< Mean, world [m/s].
  Eigen::Matrix3d velocityCovariance() const;  ///< [m^2/s^2]

  /// That it rests, one way or the other [0..1].
  double stillProbability() const { return resting_weights_.sum(); }

 private:
  static constexpr int kMoving = 4;  // smooth, gentle, brisk, sudden

  void stop(double duration);
  void change(double duration);
  bool linearize(const geometry::Camera& camera,
                 const Eigen::Vector3d& point,
                 PixelPrediction* prediction) const;
  bool isLinear(const geometry::Camera& camera,
                const PixelPrediction& prediction,
                const Eigen::Vector2d& pixel) const;
  void forgetUnseen(const geometry::Camera& camera);
  void apply(const PixelPrediction& prediction, const Eigen::Vector2d& pixel);

  const MotionOptions* options_;
  double time_;
  double stopped_until_;  // stops are taken into account up to here [s]
  double changed_until_;  // all other changes between ways to move up to here [s]
  double updated_;        // last update [s]
  double sides_seen_;     // when it last was seen from another side [s]
  Eigen::Vector3d view_ = Eigen::Vector3d::Zero();  // from which camera, then [m]
  Pair resting_weights_;                            // probabilities
  Lanes moving_weights_;
  RestingStates resting_;
  KinematicStates moving_;
};

}  // namespace wiimote_tracker::motion

#endif  // WIIMOTE_TRACKER_TRIANGULATION_MOTION_MOTION_FILTER_H
