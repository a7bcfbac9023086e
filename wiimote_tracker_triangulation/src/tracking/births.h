#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_BIRTHS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_BIRTHS_H

#include "encounter.h"
#include "group_camera.h"
#include "ids.h"
#include "stored_image.h"
#include "track.h"
#include "wiimote_tracker_triangulation/association/associate_views.h"
#include "wiimote_tracker_triangulation/geometry/sight.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace wiimote_tracker::tracking {

/// The spots of a camera's newest image that belong to no track.
struct Unexplained {
  double time = -1e300;  // [s]
  bool full = false;     // the image's
  std::size_t count = 0;
  std::array<Eigen::Vector2d, association::kMaximumSpots> pixels;
  std::array<SpotKey, association::kMaximumSpots> keys;

  void remove(std::size_t spot);
};

/// Begins tracks where unexplained spots of several cameras meet, or finds those again that are
/// missed and may be there.
class Births {
 public:
  /// @param rig of the group's cameras alone. @param partners see association::sharedViews.
  /// @param options must outlive the tracks: their filters refer to options.motion.
  Births(const geometry::Rig& rig,
         const std::vector<std::vector<std::size_t>>& partners,
         const TrackerOptions& options);

  /// Looks for LEDs at the time of the camera's newest image. What they explain is taken out of
  /// `unexplained`.
  void find(const std::vector<GroupCamera>& cameras,
            std::size_t newest,
            const std::vector<Encounter>& encounters,
            std::vector<Unexplained>* unexplained,
            std::vector<Track>* tracks,
            Ids* ids);

 private:
  bool collectViews(const std::vector<GroupCamera>& cameras,
                    std::size_t newest,
                    const std::vector<Unexplained>& unexplained);
  const std::optional<geometry::Sight>& sightOf(const GroupCamera& camera,
                                                std::size_t index,
                                                const Unexplained& unexplained,
                                                std::size_t spot);
  bool isWelcome(const association::AssociatedPoint& point) const;
  Track* trackOf(const motion::MotionFilter& start,
                 const std::vector<Encounter>& encounters,
                 std::vector<Track>* tracks,
                 Ids* ids) const;
  Track* missedAt(const motion::MotionFilter& found,
                  const std::vector<Encounter>& encounters,
                  std::vector<Track>* tracks) const;

  struct FoundingImage {
    std::size_t camera;
    double time;  // [s]
  };

  /// Of the spot at one place of an image.
  struct KnownSight {
    std::uint64_t image = std::numeric_limits<std::uint64_t>::max();  // none yet
    std::optional<geometry::Sight> sight;
  };

  TrackerOptions options_;
  const motion::MotionOptions* motion_;
  std::vector<std::vector<std::size_t>> partners_;
  association::ViewAssociator associator_;
  std::vector<std::array<KnownSight, association::kMaximumSpots>> known_;  // of each camera
  std::vector<std::array<geometry::Sight, association::kMaximumSpots>> sights_;
  std::vector<std::array<std::size_t, association::kMaximumSpots>> spots_;  // of the sights
  std::vector<association::View> views_;
  std::vector<SpotKey> founders_;
  std::vector<FoundingImage> founding_images_;
  std::vector<association::SpotReference> used_;
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_BIRTHS_H
