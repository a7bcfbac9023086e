#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_FUSION_LOCATOR_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_FUSION_LOCATOR_H

#include "association/associate_views.h"
#include "synchronizer.h"
#include "wiimote_tracker_triangulation/fusion/instant_fuser.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::fusion {

/// Associates the spots of one instant and triangulates the points.
class Locator {
 public:
  struct Point {
    geometry::TriangulatedPoint located;
    double last_observed;    ///< Newest image of its spots [s].
    std::size_t first_spot;  ///< In spots().
    std::size_t spot_count;
  };

  /// @param rig has passed Rig::check.
  Locator(const geometry::Rig& rig, const InstantFuserOptions& options);

  /// Fills in points(): most rays first, then least reprojection error.
  void locate(const std::vector<InstantView>& views);

  const std::vector<Point>& points() const { return points_; }

  /// The spots of the points, each point's in the order of the views.
  const std::vector<association::SpotReference>& spots() const { return spots_; }

 private:
  void associate(const std::vector<InstantView>& views);
  bool fits(const std::optional<geometry::TriangulatedPoint>& point) const;
  std::optional<geometry::TriangulatedPoint> triangulateWithoutWorst();

  InstantFuserOptions options_;
  std::vector<geometry::Camera> ray_cameras_;
  association::ViewAssociator associator_;

  // Of one instant.
  std::vector<std::vector<geometry::Sight>> sights_;     // of each view
  std::vector<std::vector<std::size_t>> spot_of_sight_;  // in its view
  std::vector<association::View> views_;
  const association::Association* association_ = nullptr;
  std::vector<Point> points_;
  std::vector<association::SpotReference> spots_;

  // Of one point.
  std::vector<association::SpotReference> rays_;
  std::vector<geometry::Observation> observations_;  // of rays_
  std::vector<geometry::Observation> subset_;
};

}  // namespace wiimote_tracker::fusion

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_FUSION_LOCATOR_H
