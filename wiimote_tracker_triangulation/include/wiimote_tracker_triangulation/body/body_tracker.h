#ifndef WIIMOTE_TRACKER_TRIANGULATION_BODY_BODY_TRACKER_H
#define WIIMOTE_TRACKER_TRIANGULATION_BODY_BODY_TRACKER_H

#include "wiimote_tracker_triangulation/association/associate_views.h"
#include "wiimote_tracker_triangulation/body/constellation.h"
#include "wiimote_tracker_triangulation/body/match_points.h"
#include "wiimote_tracker_triangulation/body/pose_filter.h"
#include "wiimote_tracker_triangulation/body/solve_pose.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/geometry/sight.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <limits>
#include <list>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::body {

struct LedGroup;

struct BodyTrackerOptions {
  double pixel_stddev = 0.5;  ///< Of each coordinate of a spot [px, > 0].
  PoseFilterOptions motion;

  /// A spot further than this from an LED's prediction is not its: squared Mahalanobis distance
  /// [1, > 0].
  double gate = 16.0;

  /// Lights closer together than this in an image may be one spot [px, >= 0].
  double merging_distance = 24.0;

  double prediction_time = 0.5;  ///< Seen by no camera for longer, a body is lost [s, > 0].
  double tracked_time = 0.03;    ///< Seen this recently, it is tracked, else predicted [s, > 0].

  // Finding a body that is not tracked.
  double window = 0.015;         ///< Images of so much time count as one [s, > 0].
  double window_motion = 0.002;  ///< What LEDs move within the window, standard deviation [m, > 0].
  double minimum_margin =
      15.0;  ///< By which the best match must beat the next (Match::margin) [> 0].
  MatchOptions match;

  double history = 0.2;         ///< Images older than the newest by more are of no use [s, >= 0].
  double maximum_range = 20.0;  ///< Cameras share no view beyond this [m, > 0].
};

/// What is known of one LED of a body.
struct LedEstimate {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< Where the pose has it, world [m].

  /// Cameras whose newest image, no older than BodyTrackerOptions::tracked_time, shows it.
  std::vector<std::size_t> cameras;

  /// How far its newest spot was from where the pose was expected to have it, in the image [px] and
  /// across the line of sight at its distance [m]; NaN without cameras.
  double residual = std::numeric_limits<double>::quiet_NaN();
  double deviation = std::numeric_limits<double>::quiet_NaN();

  /// [s]; minus infinity: not since the body was found.
  double last_observed = -std::numeric_limits<double>::infinity();
};

/// A body at the time of the newest image.
struct BodyEstimate {
  bool tracked = false;  ///< False: it is hidden, and the pose extrapolated.
  Eigen::Isometry3d world_from_body = Eigen::Isometry3d::Identity();  ///< [m]

  /// Of position [m^2] and rotation about the world axes [rad^2], in this order, then velocity
  /// [m^2/s^2] and turning [rad^2/s^2]; for exact cameras.
  MotionCovariance covariance = MotionCovariance::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< World [m/s].
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< World [rad/s].
  std::vector<LedEstimate> leds;                               ///< As in the constellation.
  double first_seen = 0.0;                                     ///< [s]
  double last_observed = 0.0;                                  ///< [s]
};

/// An LED whose name is known from how it blinks.
struct LabelledPoint {
  std::string label;
  Eigen::Vector3d position;    ///< World [m].
  Eigen::Matrix3d covariance;  ///< [m^2], positive definite.
};

/// Follows rigid bodies directly in the cameras' pixels, each image at its own time. The spots of
/// an image are shared out among the LEDs of all bodies that are tracked; what is left over belongs
/// to free LEDs, or to bodies that are not tracked yet: those are looked for in the spots of
/// several cameras, by the shape of the constellation alone, or by the labels of their LEDs.
///
/// A function of the sequence of calls. An image that is late is put in at its time. Does not
/// allocate once warm.
class BodyTracker {
 public:
  /// @throws Error (Constellation::check), geometry::InvalidRigError (Rig::check).
  BodyTracker(const geometry::Rig& rig,
              const std::vector<Constellation>& constellations,
              const BodyTrackerOptions& options);

  /// Adds the spots of a camera's image.
  /// @param time  of the exposure [s]. @param pixels  distorted, finite [px].
  /// @returns false, and does nothing, when it is too old.
  bool add(std::size_t camera, double time, const std::vector<Eigen::Vector2d>& pixels);

  /// Of each spot of the image that was added last, whether it was taken for a body's.
  const std::vector<bool>& taken() const { return taken_; }

  /// Starts the bodies of which nothing is known, as far as at least three of their LEDs are among
  /// these points of time() and lie as they do on the body.
  void startFromLabels(const std::vector<LabelledPoint>& points);

  double time() const { return time_; }  ///< Of the newest image [s].

  /// One per constellation, at time(); nothing while it is not known where the body is.
  const std::vector<std::optional<BodyEstimate>>& bodies() const { return estimates_; }

  const std::vector<Constellation>& constellations() const { return constellations_; }

  /// Forgets everything, as after a jump of time.
  void reset();

 private:
  struct Body {
    PoseFilter filter;
    double first_seen;                           // [s]
    double last_observed;                        // [s]
    std::array<double, kMaximumLeds> led_times;  // when last seen [s]
  };
  struct BodySpot {
    std::size_t body;
    std::size_t led;
    double residual;   // [px]
    double deviation;  // [m]
  };
  struct LastImage {
    double time = -std::numeric_limits<double>::infinity();
    std::vector<BodySpot> taken;
    std::vector<Eigen::Vector2d> free;  // spots of no body that is tracked, all with a ray [px]
  };
  struct Entry {
    std::size_t camera;
    double time;
    std::vector<Eigen::Vector2d> pixels;
    std::vector<std::optional<Body>> bodies_before;
    LastImage image_before;  // of this camera
  };

  void take(std::list<Entry>::iterator entry);
  void follow(std::size_t camera, double time, const std::vector<Eigen::Vector2d>& pixels);
  void update(std::size_t index,
              const LedGroup& group,
              const Eigen::Vector2d& pixel,
              const geometry::Camera& camera,
              LastImage* image);
  void dropLost(double time);
  void find(double time);
  bool start(std::size_t body,
             const Match& match,
             const association::Association& found,
             double time);
  void startAt(std::size_t body, const SolvedPose& pose, double time);
  void estimate();
  void estimateLeds(std::size_t body, BodyEstimate* estimate) const;

  geometry::Rig rig_;
  std::vector<geometry::Camera> cameras_;  // of the rays
  std::vector<Constellation> constellations_;
  std::vector<bool> has_clear_shape_;  // of each constellation: not symmetric
  BodyTrackerOptions options_;
  association::ViewAssociator associator_;

  // The state.
  std::vector<std::optional<Body>> bodies_;
  std::vector<LastImage> images_;  // per camera
  std::list<Entry> history_;       // in the order of their times

  double time_ = -std::numeric_limits<double>::infinity();
  std::vector<std::optional<BodyEstimate>> estimates_;
  std::vector<bool> taken_;

  // Reused.
  std::list<Entry> spare_;
  std::vector<bool> spots_taken_;
  std::vector<std::vector<geometry::Sight>> sights_;
  std::vector<association::View> views_;
  std::vector<MeasuredPoint> points_;
  std::vector<LedObservation> observations_;
};

}  // namespace wiimote_tracker::body

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BODY_BODY_TRACKER_H
