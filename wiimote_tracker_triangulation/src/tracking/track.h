#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_TRACK_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_TRACK_H

#include "motion/motion_filter.h"
#include "ray_agreement.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <Eigen/Core>
#include <boost/container/static_vector.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace wiimote_tracker::tracking {

/// A camera's latest images of one track.
struct CameraRecord {
  std::size_t camera = 0;  // in the rig
  // Times of the last image [s]:
  double last_expected = 0.0;        // that should show the LED
  double last_saturated = 0.0;       // that should show it, but has as many spots as it can have
  double last_detected = 0.0;        // with a spot of the LED
  double last_detected_alone = 0.0;  // with a spot that was not assigned to another LED, too
  double squared_residual = 0.0;     // of the last spot [px^2]
  RayOffset ray;                     // of recent spots of its own
  unsigned recent = 0;               // one bit per image, the newest lowest: detected or missed
};

/// The track of one LED, tentative or confirmed. A value type that never allocates.
class Track {
 public:
  Track(const motion::MotionFilter& start, std::uint32_t led_id);

  /// Missed detection: the camera should have shown the LED and did not.
  void miss(std::size_t camera, double time);

  /// The camera has the LED in view, but shows as many others as it can.
  void noteSaturated(std::size_t camera, double time);

  /// The filter was updated with a camera's spot, at its present time. @param residual [px]
  /// @param other with which it may be merged; null: the spot is of this LED alone.
  /// @param is_own false: a merged spot that is assigned to the other LED.
  void hit(std::size_t camera, const Eigen::Vector2d& residual, const Track* other, bool is_own);

  /// How far the ray of a camera's last spot was from the prediction.
  void noteRay(std::size_t camera, const RayOffset& ray);

  /// The filter was initialised with a camera's spot, among others.
  /// @param time of its image [s] @param residual [px]
  void addInitialSpot(std::size_t camera, double time, double residual);

  /// The track may have changed places with another one. @param probability that it did not [0..1]
  void noteMeeting(double probability) { same_led_probability_ *= probability; }

  /// Continues as a track that turned out to be of the same LED, under this track's id.
  void continueAs(const Track& found);
  void finish() { finished_ = true; }
  double startedAt() const { return started_; }  // first image, or first since continueAs() [s]

  /// Forgets the cameras' records, after a change of the rig.
  void forgetCameras() { records_.clear(); }

  /// Unknown LEDs may be merged with this one, see isInCrowd().
  void noteCrowd(double time);

  /// Whether they are, or lately were: the filter forgets merged spots with some delay.
  bool isCrowded(double time) const;

  /// Confirms or finishes the track given the detections up to a time [s].
  /// @param in_crowd whether some track isCrowded()
  void updateStatus(double time, const TrackerOptions& options, bool in_crowd);

  /// Whether the newest image of some camera with a spot of one of the two, at a time [s] or later,
  /// has one of the other too.
  bool isShownBeside(const Track& other, double since) const;

  /// Whether the rays of the cameras that see it have met for long.
  bool raysMeet() const { return agreement_.areLikelyOne(); }

  double lastDetectedBy(std::size_t camera) const;  // [s]; negative infinity: never

  /// Whether the camera's last image should have shown it and did not.
  bool wasMissedBy(std::size_t camera) const;

  /// Other cameras that detected it at a time [s] or later.
  CameraList othersSeeing(std::size_t camera, double since) const;

  /// Cameras with a spot of this LED's own at a time [s] or later.
  std::size_t camerasShowing(double since) const;

  bool isFinished() const { return finished_; }

  /// Whether another track that shares nearly all spots follows the same LED and is the better one:
  /// most spots were assigned to it, or about half and it is the older one.
  bool isDuplicate() const;

  bool isConfirmed() const { return confirmed_; }

  /// Whether a tentative track may continue that of a lost LED. This takes less than to confirm a
  /// new LED.
  bool mayContinue() const { return may_continue_ && !finished_; }

  /// A cheap linear prediction of the position [m], to select cameras that may see it.
  Eigen::Vector3d approximatePosition(double time) const;

  double lastObserved() const { return last_observed_; }  // [s]

  /// Writes the LED at a time not before the filter's, without the covariance of the calibration.
  void report(double time, const TrackerOptions& options, TrackedLed* led) const;

  motion::MotionFilter filter;
  std::uint32_t id;

 private:
  /// Numbers of cameras, by their images within tracked_time.
  struct Visibility {
    std::size_t expected = 0;                // should show the LED
    std::size_t in_view = 0;                 // should show it, or show as many others as they can
    std::size_t detected = 0;                // show it
    std::size_t supporting = 0;              // showed it in two of their last four images
    double squared_residuals = 0.0;          // sum over those that show it [px^2]
    std::array<const RayOffset*, 2> rays{};  // of the first two that show it
  };

  CameraRecord& recordOf(std::size_t camera);
  Visibility visibilityAt(double time, const TrackerOptions& options) const;
  bool isDoubtful(std::size_t seen_by, std::size_t in_view) const;
  void weighRays(const Visibility& now, double time, const TrackerOptions& options);
  void updateTentative(const Visibility& now,
                       double time,
                       const TrackerOptions& options,
                       bool in_crowd);

  double initiated_;      // TrackedLed::first_seen; stays with continueAs() [s]
  double started_;        // see startedAt() [s]
  double last_observed_;  // by any camera [s]
  double last_located_;   // by two cameras within tracked_time [s]
  // Since when and until when unknown LEDs were noted, see noteCrowd() [s].
  double crowded_since_ = 0.0;
  double last_crowded_ = -std::numeric_limits<double>::infinity();
  double unmerged_share_ = 1.0;  // share of recent spots that are this LED's alone
  double own_share_ = 0.5;       // share of recent merged spots assigned to this LED
  std::uint32_t shared_with_ = 0;
  double same_led_probability_ = 1.0;  // as in TrackedLed
  std::size_t initial_spots_ = 0;
  std::size_t hits_ = 0;  // further spots of this LED alone
  std::size_t misses_in_a_row_ = 0;
  RayAgreement agreement_;
  bool may_continue_ = false;
  bool confirmed_ = false;
  bool finished_ = false;
  Eigen::Vector3d position_;  // at position_time_ [m]
  Eigen::Vector3d velocity_;  // [m/s]
  double position_time_;      // [s]
  boost::container::static_vector<CameraRecord, kMaximumCameras> records_;
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_TRACK_H
