#ifndef WIIMOTE_TRACKER_TRIANGULATION_BODY_BODY_TRACKER_H
#define WIIMOTE_TRACKER_TRIANGULATION_BODY_BODY_TRACKER_H

#include "wiimote_tracker_triangulation/association/associate_views.h"
#include "wiimote_tracker_triangulation/body/body_filter.h"
#include "wiimote_tracker_triangulation/body/constellation.h"
#include "wiimote_tracker_triangulation/body/match_points.h"
#include "wiimote_tracker_triangulation/body/solve_pose.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/geometry/sight.h"
#include "wiimote_tracker_triangulation/tracking/history.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::body {

struct LedGroup;
class LedGroups;

struct BodyTrackerOptions {
  double pixel_stddev = 0.5;     ///< Noise per coordinate of a spot [px, > 0].
  bool learnt_noise = true;      ///< Updates use the calibration's (geometry::pixelNoise).
  double stamp_stddev = 0.0005;  ///< Of images without one of their own [s, >= 0].
  PoseFilterOptions motion;
  InertialOptions inertial;  ///< Of bodies with an IMU.

  /// Gate: greatest squared Mahalanobis distance of a spot from an LED's prediction [1, > 0].
  double gate = 16.0;

  /// LEDs closer than this in an image may merge into one spot [px, >= 0].
  double merging_distance = 24.0;

  double prediction_time = 0.5;  ///< A body unseen for longer is lost [s, > 0].
  double tracked_time = 0.03;    ///< Tracked if seen this recently, else predicted [s, > 0].

  // Search for bodies that are not tracked.
  double window = 0.015;         ///< Images this close in time are combined [s, > 0].
  double window_motion = 0.002;  ///< LED motion within the window (std. dev.) [m, > 0].
  double minimum_margin = 15.0;  ///< Least Match::margin to start a body [> 0].

  double history = 0.2;         ///< Images that are later than this are dropped [s, >= 0].
  double maximum_range = 20.0;  ///< Greatest range of a camera [m, > 0].
};

/// Estimate of one LED of a body.
struct LedEstimate {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< From the pose, in the world [m].

  /// Cameras that show it in their newest image, not older than BodyTrackerOptions::tracked_time.
  std::vector<std::size_t> cameras;

  /// Distance of the newest spot from its prediction: in the image [px], and across the line of
  /// sight at the LED's depth [m]. NaN without cameras.
  double residual = std::numeric_limits<double>::quiet_NaN();
  double deviation = std::numeric_limits<double>::quiet_NaN();

  /// [s]; minus infinity: not seen since the body was found.
  double last_observed = -std::numeric_limits<double>::infinity();
};

/// A body at the time of the newest image.
struct BodyEstimate {
  bool tracked = false;   ///< False: hidden, the pose is extrapolated.
  bool inertial = false;  ///< By an IMU, since the body was last seen.
  bool lost = false;      ///< The last estimate: the pose is unknown from here on.
  Eigen::Isometry3d world_from_body = Eigen::Isometry3d::Identity();  ///< [m]

  /// Order: position [m^2], rotation about the world axes [rad^2], velocity [m^2/s^2], angular
  /// velocity [rad^2/s^2]. The pose's block includes the errors of the calibration where the rig
  /// has their covariance; on velocities their effect is negligible.
  MotionCovariance covariance = MotionCovariance::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();          ///< World [m/s].
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< World [rad/s].
  std::vector<LedEstimate> leds;                               ///< As in the constellation.
  double first_seen = 0.0;                                     ///< [s]
  double last_observed = 0.0;                                  ///< [s]
};

/// An LED identified by its blink code.
struct LabelledPoint {
  std::string label;
  Eigen::Vector3d position;    ///< World [m].
  Eigen::Matrix3d covariance;  ///< [m^2], positive definite.
};

/// Tracks rigid bodies by the pixels of each camera image, at the time of that image. Spots of an
/// image are first assigned to the LEDs of tracked bodies. Bodies that are not tracked are searched
/// among the remaining spots of several cameras, by the shape of the constellation, or by the
/// labels of their LEDs. Other remaining spots belong to free LEDs.
///
/// The result depends on the sequence of calls only. Late images are processed in the order of
/// their times. Does not allocate once warm.
class BodyTracker {
 public:
  /// @throws Error (Constellation::check), geometry::InvalidRigError (Rig::check).
  BodyTracker(const geometry::Rig& rig,
              const std::vector<Constellation>& constellations,
              const BodyTrackerOptions& options);

  /// Computes the images that are kept (BodyTrackerOptions::history) again with another rig. Bodies
  /// that are hidden in all of them are lost. @throws geometry::InvalidRigError (Rig::check).
  void setRig(const geometry::Rig& rig);

  /// Tracks these bodies from now on. Those that were tracked before, with the same constellation,
  /// go on. @throws Error (Constellation::check).
  void setBodies(const std::vector<Constellation>& constellations);

  /// Adds the spots of a camera's image.
  /// @param time exposure [s]. @param stamp_stddev of that time [s, >= 0].
  /// @param pixels distorted, finite [px].
  /// @returns false, and does nothing, if the image is too old.
  bool add(std::size_t camera,
           double time,
           double stamp_stddev,
           const std::vector<Eigen::Vector2d>& pixels);

  /// Adds a sample of the IMU of a body, whose constellation has one. A late sample changes the
  /// estimates from the next image on.
  void addInertial(std::size_t body, const InertialSample& sample);

  /// For each spot of the image added last: whether it was assigned to a body.
  const std::vector<bool>& taken() const { return taken_; }

  /// Starts bodies that are unknown, if at least three of their LEDs are among these points at
  /// time() and agree with the constellation.
  void startFromLabels(const std::vector<LabelledPoint>& points);

  double time() const { return time_; }  ///< Of the newest image [s].

  /// One per constellation, at time(); nothing while the body's pose is unknown.
  const std::vector<std::optional<BodyEstimate>>& bodies() const { return estimates_; }

  /// Forgets all state, as after a jump in time.
  void reset();

 private:
  struct Body {
    BodyFilter filter;
    double first_seen;                           // [s]
    double last_observed;                        // [s]
    double found_time;                           // when it was started, last [s]
    std::size_t found_spots;                     // that told its pose then
    std::array<double, kMaximumLeds> led_times;  // when last seen [s]
  };
  struct SpotLed {
    std::size_t body;
    std::size_t led;
  };
  struct BodySpot : SpotLed {
    bool is_further;  // merged with the one before
    Eigen::Vector2d pixel;
    double misfit;     // squared Mahalanobis distance from the prediction [1]
    double residual;   // [px]
    double deviation;  // [m]
  };
  struct MatchedSpot {
    std::size_t led;
    std::size_t camera;
    Eigen::Vector2d pixel;
  };
  struct LastImage {
    double time = -std::numeric_limits<double>::infinity();
    std::vector<BodySpot> taken;
    std::vector<Eigen::Vector2d> free;  // spots of no tracked body [px]

    std::size_t countSpots(std::size_t body) const;
  };
  struct LabelStart {
    std::size_t body;
    BodyPose pose;
  };
  struct Image {
    std::size_t camera;
    double time;
    double stamp_stddev;
    std::vector<Eigen::Vector2d> pixels;
    std::vector<LabelStart> starts;  // of bodies that were unknown after this image

    bool operator<(const Image& other) const {
      return time != other.time ? time < other.time : camera < other.camera;
    }
  };
  /// Everything that a late image may change.
  struct State {
    std::vector<std::optional<Body>> bodies;
    std::vector<LastImage> images;  // per camera
  };

  void useRig(const geometry::Rig& rig);
  std::uint64_t firstOutdated(std::uint64_t place);
  void step(std::uint64_t place);
  void follow(const Image& image);
  bool take(std::size_t spot, const Image& image, LastImage* last);
  void update(std::size_t index,
              const LedGroup& group,
              const Eigen::Vector2d& pixel,
              const geometry::Camera& camera,
              LastImage* image);
  SpotNoise noiseOf(const Image& image, double spots) const;
  LedGroups groupsOf(std::size_t body, const Image& image, double spots) const;
  void assign(const Image& image);
  std::array<bool, kMaximumLeds> ledsWithSpot(std::size_t body) const;
  bool hasMerged(const LedGroups& groups,
                 const Image& image,
                 std::size_t spot,
                 const std::array<bool, kMaximumLeds>& has_spot) const;
  void leaveToSearch(double time);
  bool isSeen(std::size_t body, const LastImage& image);
  void dropLost(double time);
  association::AssociationOptions searchOptions() const;
  bool isTracked(std::size_t body, double time) const;
  std::size_t countSpots(std::size_t body, double time) const;
  std::optional<std::size_t> neededSpots(std::size_t body, double time) const;
  void find(const Image& image);
  const association::Association& locateSpots(double time);
  void listMatchedSpots(std::size_t body,
                        const Match& match,
                        const association::Association& found);
  bool updateByMatch(std::size_t body, const Image& image);
  bool start(std::size_t body, const Match& match, double time);
  void startAt(std::size_t body, const BodyPose& pose, double time, std::size_t spots);
  void estimate();
  void estimateLeds(std::size_t body, BodyEstimate* estimate) const;

  geometry::Rig rig_;
  std::vector<geometry::Camera> cameras_;  // as Rig::rayCamera
  std::vector<Constellation> constellations_;
  std::vector<bool> has_clear_shape_;  // per constellation: not symmetric
  BodyTrackerOptions options_;
  std::optional<association::ViewAssociator> associator_;  // always

  State state_;
  tracking::History<Image, State> history_;
  std::vector<InertialSamples> inertial_;  // per body; empty without IMU
  double inertial_change_ =
      std::numeric_limits<double>::infinity();  // images after it are outdated
  std::size_t images_since_repeat_ = 0;         // of outdated images

  double time_ = -std::numeric_limits<double>::infinity();
  std::vector<std::optional<BodyEstimate>> estimates_;
  std::vector<bool> taken_;  // see taken()

  // Of the image of the last step().
  std::vector<std::optional<SpotLed>> led_of_spot_;  // nothing: free
  std::vector<bool> spots_taken_;                    // by a body

  // Of the last search, in the newest images of all cameras.
  std::vector<std::optional<std::size_t>> needed_spots_;  // per body, see neededSpots()
  std::vector<std::vector<Eigen::Vector2d>> candidates_;  // spots to search, per camera [px]
  std::vector<std::vector<geometry::Sight>> sights_;      // theirs
  std::vector<association::View> views_;
  std::vector<MeasuredPoint> points_;
  std::vector<MatchedSpot> matched_spots_;    // of one match
  std::vector<LedObservation> observations_;  // the same

  // Reused buffers.
  Image image_;                               // of add()
  std::vector<geometry::Sight> body_sights_;  // of isSeen()
};

}  // namespace wiimote_tracker::body

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BODY_BODY_TRACKER_H
