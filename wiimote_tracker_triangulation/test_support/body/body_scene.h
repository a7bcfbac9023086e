#pragma once

#include "body/body_tracker.h"
#include "geometry/random_rigs.h"
#include "tracking/scene.h"

#include <Eigen/Geometry>

#include <functional>
#include <optional>
#include <vector>

namespace wiimote_tracker::body::test {

/// A body's pose in the world at a time [s].
using Motion = std::function<Eigen::Isometry3d(double)>;

/// Four LEDs about 100 mm from their middle. Their nearest symmetry fits within 11.5 mm; without
/// the last LED, within 0.5 mm.
Constellation fourLeds();

/// Three LEDs 86 to 186 mm from each other.
Constellation threeLeds();

/// Any orientation, within 0.5 m of a centre along each axis.
Eigen::Isometry3d randomPose(geometry::test::Random& random, const Eigen::Vector3d& center);

/// Gaussian, of this standard deviation along each axis.
Eigen::Vector3d noise(geometry::test::Random& random, double stddev);

/// As in a hand: up to 0.6 m/s.
Eigen::Isometry3d handheld(double time);

/// Held in a hand that keeps still: up to 13 mm/s and 0.2 rad/s, with tremor.
Eigen::Isometry3d held(double time);

/// Shaken: up to 1.5 m/s and 9 rad/s.
Eigen::Isometry3d shaken(double time);

/// 360 degrees per second.
Eigen::Isometry3d tumbling(double time);

/// Of a body's LEDs.
std::vector<tracking::test::Path> pathsOf(const Constellation& body, const Motion& motion);

/// Gives a copy of an image to a tracker.
void take(const tracking::test::SceneImage& image, BodyTracker* tracker);

/// Gives the pixels of an image with an exact stamp [s], which comes at once, to a tracker.
void take(std::size_t camera,
          double time,
          const std::vector<Eigen::Vector2d>& pixels,
          BodyTracker* tracker);

/// Small rotation from one orientation to another, about the world's axes [rad].
Eigen::Vector3d rotationError(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to);

/// Normalised squared error of position and rotation [1]: 6 on average for a consistent covariance.
double normalisedError(const Eigen::Isometry3d& truth,
                       const Eigen::Isometry3d& found,
                       const PoseCovariance& covariance);

/// Cramer-Rao bound of a pose seen once by each camera that has an LED in view, by differences of
/// Camera::project.
PoseCovariance boundOf(const geometry::Rig& rig,
                       const Constellation& body,
                       const Eigen::Isometry3d& pose,
                       double pixel_stddev);

/// A body that moves in front of cameras, and a tracker that follows it image by image.
class FollowedBody {
 public:
  FollowedBody(const geometry::Rig& rig,
               const Constellation& body,
               const Motion& motion,
               const tracking::test::SceneOptions& options,
               unsigned seed);

  void step() {
    show();
    track();
  }

  void show();   ///< Simulates the next image.
  void track();  ///< Gives that image to the tracker.

  double time() const { return tracker_.time(); }
  const std::optional<BodyEstimate>& estimate() const { return tracker_.bodies()[0]; }
  Eigen::Isometry3d truth() const { return motion_(time()); }
  Eigen::Vector3d trueVelocity() const;         ///< World [m/s].
  Eigen::Vector3d trueAngularVelocity() const;  ///< World [rad/s].

  const geometry::Rig& rig() const { return rig_; }
  const Constellation& body() const { return body_; }
  double pixelNoise() const { return pixel_noise_; }  ///< [px]

 private:
  geometry::Rig rig_;
  Constellation body_;
  Motion motion_;
  double pixel_noise_;
  tracking::test::Scene scene_;
  BodyTracker tracker_;
  tracking::test::SceneImage image_;
};

/// Accuracy of following a body, compared with the bound for one image per camera. Shares count all
/// added images; errors every eighth, since neighbouring ones are correlated.
class BodyScore {
 public:
  void add(const FollowedBody& followed);

  double position() const;       ///< RMS error [m].
  double positionRatio() const;  ///< Over the bound [1].
  double rotation() const;       ///< RMS error [rad].
  double rotationRatio() const;
  double velocity() const;         ///< RMS error [m/s].
  double angularVelocity() const;  ///< RMS error [rad/s].
  double nees() const;  ///< Normalised error per coordinate: 1 when the covariance is consistent.
  double ratesNees() const;  ///< Of velocity and angular velocity.
  double known() const;      ///< Share of images after which there was a pose.
  double wrong() const;      ///< Share of those more than 20 degrees off: a wrong assignment.

 private:
  double images_ = 0.0, known_ = 0.0, wrong_ = 0.0, judged_ = 0.0;
  double position_ = 0.0, rotation_ = 0.0, nees_ = 0.0, rates_nees_ = 0.0;  // sums of squares
  double velocity_ = 0.0, angular_velocity_ = 0.0;
  double position_bound_ = 0.0, rotation_bound_ = 0.0;
};

}  // namespace wiimote_tracker::body::test
