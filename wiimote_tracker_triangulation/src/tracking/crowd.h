#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_CROWD_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_CROWD_H

#include "group_camera.h"
#include "track.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace wiimote_tracker::tracking {

/// More lights than the cameras of a group can report. An LED that they do not report has no track,
/// but it may be merged with one that has: the spot is then between both, at most half of
/// merging_distance from either. Residuals do not always show that, nor does a third camera, which
/// may face another one.
class Crowd {
 public:
  /// All arguments must outlive it. @param members indices of the cameras in the rig.
  /// @param views of the rig's cameras at a time [s]
  Crowd(const std::vector<GroupCamera>& cameras,
        const std::vector<std::size_t>& members,
        const std::vector<Track>& tracks,
        const TrackerOptions& options,
        const std::vector<CameraView>& views,
        double time)
      : cameras_(cameras),
        members_(members),
        tracks_(tracks),
        options_(options),
        views_(views),
        time_(time) {}

  /// Covariance of an LED's position where unknown LEDs may be merged with it; else zero [m^2].
  Eigen::Matrix3d mergingCovariance(const TrackedLed& led) const;

 private:
  /// Whether a full camera shows an unknown light instead of an LED in its view, and another one
  /// shows an unknown light or not the LED. What one camera alone shows may be a lamp, or the
  /// camera was moved.
  bool mayHideLedsNear(const TrackedLed& led) const;
  bool isFull(std::size_t member) const;
  bool isHiddenIn(std::size_t member, const TrackedLed& led) const;
  bool hasUnknownLight(std::size_t member) const;
  const CameraView& viewOf(std::size_t member) const { return views_[members_[member]]; }

  const std::vector<GroupCamera>& cameras_;
  const std::vector<std::size_t>& members_;
  const std::vector<Track>& tracks_;
  const TrackerOptions& options_;
  const std::vector<CameraView>& views_;
  double time_;
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_CROWD_H
