#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_CAMERA_GROUP_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_CAMERA_GROUP_H

#include "births.h"
#include "encounter.h"
#include "group_camera.h"
#include "history.h"
#include "ids.h"
#include "image_update.h"
#include "stored_image.h"
#include "track.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace wiimote_tracker::tracking {

/// Cameras that share views, directly or through others (those of one room), and the tracks before
/// them. Groups know nothing of each other, so that each costs what it would alone.
class CameraGroup {
 public:
  /// What became of an image.
  enum class Fate { kTaken, kLate, kRepeated, kDropped };

  /// @param members their places in the rig, ascending. @param partners of all cameras of the rig.
  /// @param options must outlive the tracks, also where another group adopts them.
  CameraGroup(const geometry::Rig& rig,
              const std::vector<std::size_t>& members,
              const std::vector<std::vector<std::size_t>>& partners,
              const TrackerOptions& options);

  /// @param image of the camera at image.camera among the members.
  /// @param views one per camera of the rig; what became of spots is written into them.
  Fate add(const StoredImage& image, Ids* ids, std::vector<CameraView>* views);

  const GroupCamera& camera(std::size_t member) const { return cameras_[member]; }
  const std::vector<std::size_t>& members() const { return members_; }
  const std::vector<Track>& tracks() const { return state_.tracks; }

  /// Takes over a track of another rig's group, from here on.
  void adopt(const Track& track);

  void clear();

 private:
  /// All that a late image may change.
  struct State {
    std::vector<Track> tracks;
    std::vector<Encounter> encounters;
    std::vector<Unexplained> unexplained;  // of each camera
  };

  std::optional<std::uint64_t> mistimedBefore(std::uint64_t place, const StoredImage& image) const;
  void step(const StoredImage& image, Ids* ids, std::vector<CameraView>* views);
  void endEncounters(double time);
  void collectUnexplained(const StoredImage& image);
  void show(const StoredImage& image, std::vector<CameraView>* views) const;

  TrackerOptions options_;
  std::vector<std::size_t> members_;
  std::vector<GroupCamera> cameras_;
  ImageUpdate update_;
  Births births_;
  State state_;
  History<State> history_;
};

/// The cameras of a rig, divided into groups that share no view.
std::vector<std::vector<std::size_t>> groupsOf(
    const std::vector<std::vector<std::size_t>>& partners);

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_CAMERA_GROUP_H
