#ifndef WIIMOTE_TRACKER_TRIANGULATION_MOTION_MOTION_FILTER_H
#define WIIMOTE_TRACKER_TRIANGULATION_MOTION_MOTION_FILTER_H

#include "wiimote_tracker_triangulation/geometry/camera.h"
#include "wiimote_tracker_triangulation/motion/kinematic_states.h"
#include "wiimote_tracker_triangulation/motion/motion_options.h"
#include "wiimote_tracker_triangulation/motion/motion_steps.h"

#include <Eigen/Core>

#include <optional>

namespace wiimote_tracker::motion {

/// How exact a pixel is.
struct PixelNoise {
  double pixel_stddev = 0.5;  ///< Of each coordinate [px, > 0].
  double stamp_stddev = 0.0;  ///< Of the image's time [s, >= 0]: a moving LED smears along its way.
};

/// Where in a camera's image an LED is expected: a mixture of normal distributions, one for each
/// way it may move (see MotionOptions).
class PixelPrediction {
 public:
  const Eigen::Vector2d& pixel() const { return pixel_; }  ///< Mean [px].

  /// Innovation covariance: of a measured pixel about the mean, noise and all [px^2].
  Eigen::Matrix2d covariance() const;

  /// Squared Mahalanobis distance to the nearest of the ways to move, however unlikely that way is
  /// [1]: for gates, so that a sudden start is not shut out. For the LED's own spot no more than
  /// chi square with two degrees of freedom. NaN for a pixel that is.
  double squaredDistance(const Eigen::Vector2d& pixel) const;

  /// Logarithm of the density of the LED's spot [1/px^2].
  double logLikelihood(const Eigen::Vector2d& pixel) const;

  /// The same, but nothing where squaredDistance is not within the gate [1, >= 1]. What is far from
  /// all that is expected costs little.
  std::optional<double> logLikelihoodWithin(double gate, const Eigen::Vector2d& pixel) const;

 private:
  friend class MotionFilter;

  /// Distances of one pixel to each way to move [1].
  struct SquaredDistances {
    double still;
    Lanes moving;
    double least;
  };
  SquaredDistances squaredDistances(const Eigen::Vector2d& pixel) const;
  double logDensity(const SquaredDistances& distances) const;

  Eigen::Vector2d pixel_;
  Eigen::Matrix<double, 2, 3> jacobian_;  // d pixel / d position [px/m]
  Eigen::Vector3d smear_;                 // standard deviation that the stamp's makes [m]
  double pixel_variance_;                 // [px^2]
  double squared_reach_;  // a pixel within gate g is not further than sqrt(g) times this [px^2]

  // Of what is still, and of the four that move; a weight of 0: to be left out.
  double still_weight_;
  double still_u_, still_v_;                                    // its mean from pixel_ [px]
  double still_whiten_uu_, still_whiten_vu_, still_whiten_vv_;  // lower triangle [1/px]
  Lanes moving_weights_;
  Lanes moving_u_, moving_v_;
  Lanes moving_whiten_uu_, moving_whiten_vu_, moving_whiten_vv_;
};

/// One LED's state in continuous time, updated by each camera's spot at that image's own time: an
/// interacting multiple model filter (Blom and Bar-Shalom 1988) over the five ways of
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

  double stillProbability() const { return still_weight_; }  ///< [0..1]

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
  void apply(const PixelPrediction& prediction, const Eigen::Vector2d& pixel);

  const MotionOptions* options_;
  double time_;
  double stopped_until_;  // stops are taken into account up to here [s]
  double changed_until_;  // all other changes between ways to move up to here [s]
  double still_weight_;   // probability
  Lanes moving_weights_;  // probabilities
  Eigen::Vector3d still_p_;
  Eigen::Matrix3d still_pp_;
  KinematicStates moving_;
};

}  // namespace wiimote_tracker::motion

#endif  // WIIMOTE_TRACKER_TRIANGULATION_MOTION_MOTION_FILTER_H
