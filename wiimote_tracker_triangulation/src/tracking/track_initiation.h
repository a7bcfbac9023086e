#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_TRACK_INITIATION_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_TRACK_INITIATION_H

#include "association/associate_views.h"
#include "group_state.h"
#include "ids.h"
#include "tracker_camera.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace wiimote_tracker::tracking {

/// A spot that began a track.
struct StartSpot {
  std::size_t camera;
  std::size_t spot;   // in the camera's image
  std::uint32_t led;  // id of the track
};

/// Track initiation: starts a track where unassigned spots of several cameras form a point. Once it
/// is ready, it may turn out to continue a track that lost its LED.
class TrackInitiation {
 public:
  /// @param partners see geometry::sharedViews.
  /// @param cameras of the rig; must live longer.
  /// @param options must outlive the tracks: their filters refer to options.motion.
  /// @param ids must live longer.
  TrackInitiation(const geometry::Rig& rig,
                  const std::vector<std::vector<std::size_t>>& partners,
                  const std::vector<TrackerCamera>& cameras,
                  const TrackerOptions& options,
                  Ids* ids);

  /// Searches for LEDs at the time of camera `newest`'s image, and removes their spots from the
  /// unassigned ones.
  void apply(std::size_t newest, GroupState* state);

  /// Of the tracks that the last apply() started.
  const std::vector<StartSpot>& starts() const { return starts_; }

  /// The most likely track of the LED of a track that is ready; null: it is a new LED.
  Track* formerTrackOf(const Track& found, GroupState* state) const;

 private:
  bool collectViews(std::size_t newest);
  UnassignedSpots& unassignedOf(std::size_t camera) const {
    return state_->cameras.at(camera).unassigned;
  }
  const UnassignedSpots::Spot& spotAt(const association::SpotReference& spot) const {
    return unassignedOf(spot.view).spots[spot.spot];
  }
  bool isAllowed(const association::AssociatedPoint& point) const;
  bool mayShowInAnother(const association::AssociatedPoint& point) const;
  void start(const association::AssociatedPoint& point, double time);
  motion::MotionFilter filterOf(const association::AssociatedPoint& point) const;
  void removeUsed();

  const std::vector<TrackerCamera>& cameras_;
  const TrackerOptions& options_;
  Ids* ids_;
  std::vector<std::vector<std::size_t>> partners_;
  association::ViewAssociator associator_;
  std::vector<association::View> views_;
  std::vector<SpotKey> initial_spots_;  // of one point
  std::vector<association::SpotReference> used_;
  std::vector<StartSpot> starts_;
  GroupState* state_ = nullptr;  // of the last apply(); valid while it runs
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_TRACK_INITIATION_H
