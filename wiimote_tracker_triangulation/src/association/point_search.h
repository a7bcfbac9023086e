#pragma once

#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/geometry/sight.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace wiimote_tracker::association {

/// Costs are -2 log likelihood, like chi^2. The defaults are about those of typicalCosts.
struct AssociationOptions {
  double pixel_stddev = 0.5;  ///< Of a pixel coordinate, including calibration [px].
  double ghost = 31.0;        ///< Cost of a false detection: a spot of no point [> 0].
  double point = 35.0;        ///< Cost of a point [>= 0].
  double miss = 4.4;          ///< Cost of a missed detection [>= 0].

  /// Gate for two spots of one point: the squared distance from the epipolar constraint, to first
  /// order, over pixel_stddev^2 [> 0].
  double maximum_pair_chi_squared = 30.0;

  std::size_t minimum_rays = 2;  ///< Of a point [>= 2].
  double minimum_angle = 0.02;   ///< The widest pair of rays spans at least this [rad].

  /// The search stops after this many steps with the best association so far, proven optimal or
  /// not.
  std::size_t maximum_steps = 5000;
};

/// The spots of one camera.
struct View {
  const geometry::Sight* sights = nullptr;  ///< Not owned.
  std::size_t count = 0;
  bool watching = true;  ///< False: there is no image, so no detection is missed.
  bool full = false;     ///< As many spots as the camera can report: no detection counts as missed.
};

/// A connected component of the graph of possible pairs: its spots in the order of their views.
struct Component {
  struct Spot {
    std::size_t view;
    std::size_t index;   ///< In its view.
    std::size_t number;  ///< Among the spots of all views.
    const geometry::Sight* sight;
  };
  std::vector<Spot> spots;
  /// Of the spots of all views, row by row: chi^2 of a pair; infinite when they can not be one
  /// point.
  const double* pair_chi_squared = nullptr;
  std::size_t spots_of_all_views = 0;

  double pair(std::size_t a, std::size_t b) const {
    return pair_chi_squared[spots[a].number * spots_of_all_views + spots[b].number];
  }
};

/// Finds the association of least cost for one component by depth-first branch and bound. Each spot
/// in turn joins a point, begins one, or is a false detection ("ghost"). A branch ends when a lower
/// bound of its cost is not below that of the best association found.
class PointSearch {
 public:
  struct Point {
    std::vector<std::size_t> spots;  ///< Places in the component, ascending.
    geometry::TriangulatedPoint location;
  };

  PointSearch(const geometry::Rig& rig,
              std::vector<std::vector<std::size_t>> partners,
              const AssociationOptions& options);

  const std::vector<std::size_t>& partners(std::size_t camera) const { return partners_[camera]; }

  /// Solves the usual case without a search: all spots are one point, and this is optimal. False
  /// otherwise.
  bool solveAsOnePoint(const Component& component, const std::vector<View>& views);

  /// @returns the number of steps taken: `maximum_steps` when the result is not proven.
  std::size_t solve(const Component& component,
                    const std::vector<View>& views,
                    std::size_t maximum_steps);

  // The result.
  std::size_t pointCount() const { return best_count_; }
  const Point& point(std::size_t i) const { return best_[i]; }
  double cost() const { return best_cost_; }  ///< Of the points and the ghosts.

 private:
  using Mask = std::uint64_t;  // one bit for each of the first 64 spots

  /// How well the spots of a draft fit together.
  struct Fit {
    bool is_known = false;     // else chi_squared is a lower bound and the rest unset
    bool is_possible = false;  // they triangulate (more spots may help if not)
    double chi_squared = 0.0;
    geometry::TriangulatedPoint location;
  };
  /// A point that has been begun.
  struct Draft {
    std::vector<std::size_t> spots;
    Mask possible = 0;  // spots that can join all of these
    Fit fit;
  };

  void reserve(std::size_t spots);
  void begin(const Component& component, const std::vector<View>& views);
  void prepare();
  void decide(std::size_t spot, std::size_t ghosts);
  void tryJoining(std::size_t spot, std::size_t ghosts);
  void tryBeginning(std::size_t spot, std::size_t ghosts);
  void finish(std::size_t ghosts);
  bool isWorthwhile(std::size_t next_spot, std::size_t ghosts) const;
  double leastCostOfUnjoinable(std::size_t next_spot) const;
  bool isPoint(const Draft& draft) const;
  double meanPairCost(const Draft& draft, std::size_t spot) const;
  void findFit(Draft* draft);
  double missesOf(const Draft& draft) const;

  AssociationOptions options_;
  geometry::TriangulationOptions triangulation_;
  std::vector<geometry::Camera> cameras_;
  std::vector<std::vector<std::size_t>> partners_;

  const Component* component_ = nullptr;
  const std::vector<View>* views_ = nullptr;
  std::vector<Mask> partner_spots_;  // per spot: spots that can share a point with it
  std::vector<double> least_costs_;  // per spot: as a false detection, or its share of a point
  std::size_t steps_ = 0;
  std::size_t maximum_steps_ = 0;
  std::vector<Draft> drafts_;  // the first draft_count_ are in use; the others keep their buffers
  std::size_t draft_count_ = 0;
  std::vector<Point> best_;  // likewise
  std::size_t best_count_ = 0;
  double best_cost_ = 0.0;
  bool has_association_ = false;         // an association has been completed
  std::vector<geometry::Sight> sights_;  // of one draft
  std::vector<double> costs_;            // of the drafts
};

}  // namespace wiimote_tracker::association
