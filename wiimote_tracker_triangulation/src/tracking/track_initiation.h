#pragma once

#include "association/associate_views.h"
#include "group_state.h"
#include "ids.h"

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

/// Track initiation: starts a track where unassigned spots of several cameras form a point.
class TrackInitiation {
 public:
  /// @param setup its parts must live longer, and options longer than the tracks: their filters
  /// refer to options.motion. @param partners see geometry::sharedViews. @param ids must live
  /// longer.
  TrackInitiation(const GroupSetup& setup,
                  const std::vector<std::vector<std::size_t>>& partners,
                  Ids* ids);

  /// Searches for LEDs at the time of camera `newest`'s image, and removes their spots from the
  /// unassigned ones.
  /// @returns these spots, until the next call
  const std::vector<StartSpot>& apply(std::size_t newest, GroupState* state);

 private:
  bool collectViews(std::size_t newest, const CameraStates& cameras);
  bool mayShowInAnother(const association::AssociatedPoint& point,
                        const CameraStates& cameras) const;
  void start(const association::AssociatedPoint& point, double time, GroupState* state);

  GroupSetup setup_;
  Ids* ids_;
  std::vector<std::vector<std::size_t>> partners_;
  association::ViewAssociator associator_;
  // Reused:
  std::vector<association::View> views_;
  std::vector<SpotKey> initial_spots_;  // of one point
  std::vector<StartSpot> starts_;
};

}  // namespace wiimote_tracker::tracking
