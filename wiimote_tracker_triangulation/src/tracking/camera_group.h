#pragma once

#include "clock_offsets.h"
#include "group_state.h"
#include "track_initiation.h"
#include "tracking/history.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace wiimote_tracker::tracking {

/// Cameras that share views, directly or through others (those of one room), and the tracks that
/// they see. Groups are independent of each other.
class CameraGroup {
 public:
  /// @param setup its parts must live longer, with useRig() where they change, and options longer
  /// than the tracks, also those that another group adopts.
  /// @param members the group's cameras, as their indices in the rig, ascending.
  /// @param partners see geometry::sharedViews.
  /// @param ids, views must live longer; `views`, one per camera of the rig, get the use of spots.
  CameraGroup(const GroupSetup& setup,
              const std::vector<std::size_t>& members,
              const std::vector<std::vector<std::size_t>>& partners,
              Ids* ids,
              std::vector<CameraView>* views);

  /// Steps follow with the next image in order, or update(): a late image may come after others.
  /// @param image of a member.
  Outcome add(const StoredImage& image);

  /// Carries out the steps of all images.
  void update();

  /// Whether a camera's images do not fit the others'. With more than two cameras they are left
  /// out.
  bool isMisfit(std::size_t camera) const { return state_.cameras.at(camera).fit.isMisfit(); }

  /// Whether errors of the calibration explain most of that.
  bool isExplained(std::size_t camera) const { return state_.cameras.at(camera).fit.isExplained(); }

  /// Whether there are only two cameras, which do not fit each other: then no LED is located.
  bool isMisfitPair() const;

  ClockOffsets& clocks() { return clocks_; }
  const ClockOffsets& clocks() const { return clocks_; }

  const std::vector<std::size_t>& members() const { return members_; }
  const std::vector<Track>& tracks() const { return state_.tracks; }

  /// Goes on with slightly better poses and lenses of the same cameras, whose clocks are the same.
  void useRig(const std::vector<std::vector<std::size_t>>& partners);

  /// Takes over a track from a group of another rig.
  void adopt(const Track& track);

  void clear();

 private:
  void step(const StoredImage& image);
  void updateStatuses(double time, bool in_crowd);
  void collectUnassigned(const StoredImage& image, const association::TrackOfSpot& track_of_spot);
  void show(const StoredImage& image, const association::TrackOfSpot& track_of_spot) const;
  void showStarts(const std::vector<StartSpot>& starts) const;

  GroupSetup setup_;
  Ids* ids_;
  std::vector<CameraView>* views_;
  std::vector<std::size_t> members_;
  std::optional<TrackInitiation> initiation_;  // never empty
  ClockOffsets clocks_;
  GroupState state_;
  History<StoredImage, GroupState> history_;
};

}  // namespace wiimote_tracker::tracking
