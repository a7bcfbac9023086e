#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_TRACK_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_TRACK_H

#include "wiimote_tracker_triangulation/motion/motion_filter.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>

namespace wiimote_tracker::tracking {

/// What one camera last had to say about a track.
struct Look {
  std::size_t camera = 0;         // in its group
  double time = 0.0;              // of the last image that ought to show the LED [s]
  double hit = 0.0;               // of the last one that did [s]
  double own = 0.0;               // of the last one whose spot was no other LED's [s]
  double squared_residual = 0.0;  // of that spot [px^2]
  unsigned recent = 0;            // one bit per image, the last one lowest: shown or not
};

/// One LED, or what may be one. A value: copies are independent, nothing allocates.
class Track {
 public:
  /// Cameras remembered; of more that see one LED, those that did so last.
  static constexpr std::size_t kMaximumLooks = 12;

  Track(const motion::MotionFilter& start, std::uint32_t led_id);

  /// A camera ought to have shown it, and did not.
  void miss(std::size_t camera, double time);

  /// A camera's spot was taken in at the filter's time. @param residual [px] @param is_own not
  /// another LED's, with which it was taken to be one spot.
  void hit(std::size_t camera, const Eigen::Vector2d& residual, bool is_own);

  /// Of such a spot: no other LED may be behind it.
  void noteAlone();

  /// Of such a spot: another LED may be behind it.
  void noteShared(std::uint32_t other, bool is_own);

  /// A camera's spot was among those that the filter begins with. @param residual [px]
  void foundBy(std::size_t camera, double residual);

  /// It was found again elsewhere than expected: its motion begins anew.
  void restart(const motion::MotionFilter& start);
  double startedAt() const { return started_; }  // birth or last restart [s]

  /// Forgets which cameras saw it, for a rig whose cameras are others.
  void forgetCameras() { look_count_ = 0; }

  /// Confirms, or notes that it has to go.
  void judge(double time, const TrackerOptions& options);
  /// Whether the camera's image of that time [s] had a spot of its own.
  bool isShownBy(std::size_t camera, double time) const;

  /// Whether another camera showed it at a time [s] or later.
  bool isSeenBeside(std::size_t camera, double since) const;

  /// Cameras that had a spot of its own at a time [s] or later.
  std::size_t showers(double since) const;

  bool isOver() const { return over_; }
  bool isConfirmed() const { return confirmed_; }

  /// Where it roughly is [m]; for a first, cheap question of who may see it.
  Eigen::Vector3d roughPlace(double time) const;

  double lastObserved() const { return last_observed_; }  // [s]

  /// Everything that is published but the calibration's share, at a time not before the filter's.
  /// @param rig_index of the group's cameras
  void report(double time,
              const TrackerOptions& options,
              const std::vector<std::size_t>& rig_index,
              TrackedLed* led) const;

  motion::MotionFilter filter;
  std::uint32_t id;

 private:
  Look& lookOf(std::size_t camera, double time);
  bool isAnother() const;
  std::size_t supporters(double time, const TrackerOptions& options) const;

  double born_;           // [s]
  double started_;        // [s]
  double last_observed_;  // by any camera [s]
  double last_located_;   // by two cameras at about one time [s]
  double alone_ = 1.0;    // share of its recent spots that no other LED may be behind
  double owned_ = 0.5;    // share of its recent spots, of those not alone, that were its own
  std::uint32_t shares_with_ = 0;
  std::size_t hits_ = 0;  // alone
  std::size_t misses_in_a_row_ = 0;
  bool confirmed_ = false;
  bool over_ = false;
  std::size_t look_count_ = 0;
  Eigen::Vector3d place_;     // at place_time_ [m]
  Eigen::Vector3d velocity_;  // [m/s]
  double place_time_;         // [s]
  std::array<Look, kMaximumLooks> looks_;
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_TRACK_H
