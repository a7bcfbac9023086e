#pragma once

#include "association/associate_views.h"
#include "body/body_setup.h"
#include "body/body_state.h"
#include "body/body_update.h"
#include "body/match_points.h"
#include "body/solve_pose.h"
#include "wiimote_tracker_triangulation/geometry/sight.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::body {

/// Finds bodies by the shape of their constellations, among the spots of the newest images of all
/// cameras.
class BodySearch {
 public:
  /// @param setup, state, update not owned; the setup's rig is to stay.
  BodySearch(const BodySetup& setup, BodyState* state, BodyUpdate* update);

  /// Starts bodies that are not tracked, and those whose spots fit another pose better. To be
  /// called after BodyUpdate::follow().
  void find(const BodyImage& image);

 private:
  std::optional<std::size_t> neededSpots(std::size_t body, double time) const;
  bool isTracked(std::size_t body, double time) const;
  std::size_t countSpots(std::size_t body, double time) const;
  const association::Association& locateSpots(double time);
  void listMatchedSpots(std::size_t body,
                        const Match& match,
                        const association::Association& found);
  bool start(std::size_t body, const Match& match, double time);

  const BodySetup& setup_;
  BodyState& state_;
  BodyUpdate& update_;
  association::ViewAssociator associator_;
  std::vector<std::optional<std::size_t>> needed_spots_;  // per body, see neededSpots()
  std::vector<std::vector<Eigen::Vector2d>> candidates_;  // spots to search, per camera [px]
  std::vector<std::vector<geometry::Sight>> sights_;      // theirs
  std::vector<association::View> views_;
  std::vector<MeasuredPoint> points_;
  std::vector<MatchedSpot> matched_spots_;    // of one match
  std::vector<LedObservation> observations_;  // the same
};

}  // namespace wiimote_tracker::body
