#ifndef WIIMOTE_TRACKER_TRIANGULATION_BODY_BODY_TRACKER_H
#define WIIMOTE_TRACKER_TRIANGULATION_BODY_BODY_TRACKER_H

#include "wiimote_tracker_triangulation/association/associate_views.h"
#include "wiimote_tracker_triangulation/body/constellation.h"
#include "wiimote_tracker_triangulation/body/match_points.h"
#include "wiimote_tracker_triangulation/body/pose_filter.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <vector>

namespace wiimote_tracker::body {

struct BodyTrackerOptions {
  double pixel_stddev = 0.5;  ///< Of each coordinate of a spot [px, > 0].
  PoseFilterOptions motion;

  /// A spot further than this from an LED's prediction is not its: squared Mahalanobis distance
  /// [1, > 0].
  double gate = 16.0;

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

/// A body at the time of the newest image.
struct BodyEstimate {
  bool tracked = false;  ///< False: it is hidden, and the pose extrapolated.
  Eigen::Isometry3d world_from_body = Eigen::Isometry3d::Identity();  ///< [m]
  PoseCovariance covariance = PoseCovariance::Zero();  ///< As of SolvedPose; for exact cameras.
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< World [m/s].
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< World [rad/s].
  double last_observed = 0.0;                                  ///< [s]

  /// Per LED, how far its last spot was from where the pose had it, at its distance [m]; NaN when
  /// it has not been seen for tracked_time.
  std::array<double, kMaximumLeds> deviation;
};

/// Follows rigid bodies directly in the cameras' pixels, each image at its own time. The spots of
/// an image are shared out among the LEDs of all bodies that are tracked; what is left over belongs
/// to free LEDs, or to bodies that are not tracked yet: those are looked for in the spots of
/// several cameras, by the shape of the constellation alone.
///
/// A function of the sequence of images. An image that is late is put in at its time.
class BodyTracker {
 public:
  /// @throws BodyError (Constellation::check), geometry::InvalidRigError (Rig::check).
  BodyTracker(const geometry::Rig& rig,
              const std::vector<Constellation>& constellations,
              const BodyTrackerOptions& options);

  /// Adds the spots of a camera's image.
  /// @param time  of the exposure [s]. @param pixels  distorted, finite [px].
  /// @returns false, and does nothing, when it is too old.
  bool add(std::size_t camera, double time, const std::vector<Eigen::Vector2d>& pixels);

  double time() const { return time_; }  ///< Of the newest image [s].

  /// One per constellation, at time(); nothing while it is not known where the body is.
  const std::vector<std::optional<BodyEstimate>>& bodies() const { return estimates_; }

  /// Forgets everything, as after a jump of time.
  void reset();

 private:
  struct Body {
    PoseFilter filter;
    double last_observed;   // [s]
    double surprise = 1.0;  // running mean of chi^2 per coordinate; 1 when all is well
    std::array<double, kMaximumLeds> led_time;       // when last seen [s]
    std::array<double, kMaximumLeds> led_deviation;  // then [m]
  };
  struct LastImage {
    double time = -std::numeric_limits<double>::infinity();
    std::vector<Eigen::Vector2d> free;  // spots of no body that is tracked, all with a ray [px]
  };
  struct State {
    std::vector<std::optional<Body>> bodies;
    std::vector<LastImage> images;  // per camera
  };
  struct Entry {
    std::size_t camera;
    double time;
    std::vector<Eigen::Vector2d> pixels;
    State before;
  };

  void take(std::size_t camera, double time, const std::vector<Eigen::Vector2d>& pixels);
  void follow(std::size_t camera, double time, const std::vector<Eigen::Vector2d>& pixels);
  void dropLost(double time);
  void find(double time);
  bool start(std::size_t body,
             const Match& match,
             const association::Association& found,
             double time);
  void estimate();

  geometry::Rig rig_;
  std::vector<geometry::Camera> cameras_;  // of the rays
  std::vector<Constellation> constellations_;
  BodyTrackerOptions options_;
  association::ViewAssociator associator_;
  State state_;
  std::deque<Entry> history_;
  double time_ = -std::numeric_limits<double>::infinity();
  std::vector<std::optional<BodyEstimate>> estimates_;
};

}  // namespace wiimote_tracker::body

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BODY_BODY_TRACKER_H
