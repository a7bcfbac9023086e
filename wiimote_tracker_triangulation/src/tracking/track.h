#pragma once

#include "camera_records.h"
#include "crowd.h"
#include "merge_shares.h"
#include "motion/motion_filter.h"
#include "ray_agreement.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>

namespace wiimote_tracker::tracking {

/// The track of one LED, tentative or confirmed. A value type that never allocates.
class Track {
 public:
  Track(const motion::MotionFilter& start, std::uint32_t id);

  std::uint32_t id() const { return id_; }
  const motion::MotionFilter& filter() const { return filter_; }
  CameraRecords& cameras() { return cameras_; }
  const CameraRecords& cameras() const { return cameras_; }
  CrowdMemory& crowd() { return crowd_; }
  const CrowdMemory& crowd() const { return crowd_; }

  double startedAt() const { return started_; }  // first image, since it was reacquired last [s]
  double lastObserved() const { return last_observed_; }  // [s]

  /// A cheap linear prediction of the position [m], to select cameras that may see it.
  Eigen::Vector3d approximatePosition(double time) const;

  void predict(double time) { filter_.predict(time); }

  /// See MotionFilter::update(). If it is true, hit() has to follow.
  bool update(const geometry::Camera& camera,
              const motion::PixelPrediction& prediction,
              const Eigen::Vector2d& pixel) {
    return filter_.update(camera, prediction, pixel);
  }

  /// Goes on with a filter that was updated elsewhere; hit() has to follow.
  void useFilter(const motion::MotionFilter& filter) { filter_ = filter; }

  /// The filter was updated with a camera's spot, at its present time. @param residual [px]
  /// @param other with which it may be merged; null: the spot is of this LED alone.
  /// @param is_own false: a merged spot that is assigned to the other LED.
  void hit(std::size_t camera, const Eigen::Vector2d& residual, const Track* other, bool is_own);

  /// The filter was initialised with a camera's spot, among others.
  /// @param time of its image [s] @param residual [px]
  void addInitialSpot(std::size_t camera, double time, double residual);

  /// The camera should have shown the LED and did not.
  void miss(std::size_t camera, double time);

  /// The track may have changed places with another one. @param probability that it did not [0..1]
  void noteMeeting(double probability) { same_led_probability_ *= probability; }

  /// Confirms or finishes the track given the detections up to a time [s].
  /// @param in_crowd whether there is a crowd about some LED
  void updateStatus(double time, const TrackerOptions& options, bool in_crowd);

  bool isConfirmed() const { return confirmed_; }
  bool isFinished() const { return finished_; }

  /// Whether the track with which it shares nearly all spots is the better one of the same LED.
  bool isDuplicate() const { return shares_.isDuplicate(id_); }

  /// Whether the rays of the cameras that see it have met for long.
  bool raysMeet() const { return agreement_.areLikelyOne(); }

  /// Whether a tentative track may reacquire the LED of another. This takes less than to confirm a
  /// new LED.
  bool mayReacquire() const { return may_reacquire_ && !finished_; }

  /// A newer track turned out to be of the same LED: takes its state, under this track's id.
  void continueAs(const Track& newer);
  void finish() { finished_ = true; }

  /// Writes the LED at a time not before the filter's, without the covariance of the calibration.
  void report(double time, const TrackerOptions& options, TrackedLed* led) const;

 private:
  void updateConfirmed(double time, const TrackerOptions& options);
  void updateTentative(const Visibility& now,
                       double time,
                       const TrackerOptions& options,
                       bool in_crowd);
  bool mayBePhantom(std::size_t seen_by, std::size_t in_view) const;

  std::uint32_t id_;
  motion::MotionFilter filter_;
  CameraRecords cameras_;
  MergeShares shares_;
  RayAgreement agreement_;
  CrowdMemory crowd_;
  double initiated_;                   // TrackedLed::first_seen: also when reacquired [s]
  double started_;                     // see startedAt() [s]
  double last_observed_;               // by any camera [s]
  double last_located_;                // by two cameras within tracked_time [s]
  double same_led_probability_ = 1.0;  // as in TrackedLed
  std::size_t initial_spots_ = 0;
  std::size_t misses_in_a_row_ = 0;
  bool may_reacquire_ = false;
  bool confirmed_ = false;
  bool finished_ = false;
  Eigen::Vector3d position_;  // at position_time_ [m]
  Eigen::Vector3d velocity_;  // [m/s]
  double position_time_;      // [s]
};

}  // namespace wiimote_tracker::tracking
