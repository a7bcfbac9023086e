#ifndef WIIMOTE_TRACKER_TRIANGULATION_TEST_ASSOCIATION_EXHAUSTIVE_H
#define WIIMOTE_TRACKER_TRIANGULATION_TEST_ASSOCIATION_EXHAUSTIVE_H

#include "association/simulated_views.h"
#include "wiimote_tracker_triangulation/association/associate_views.h"

#include <map>
#include <set>
#include <vector>

namespace wiimote_tracker::association::test {

/// Spots of a point: per camera the spot, or -1.
using Tuple = std::vector<int>;

/// A division of all spots into points and ghosts.
struct Division {
  std::set<Tuple> points;
  double cost = 0.0;
};

/// chi^2 of the point that fits the pixels of a tuple best, by Gauss and Newton's method over the
/// cameras' own projection from a start of its own; infinite when there is none.
double chiSquared(const geometry::Rig& rig,
                  const SimulatedViews& views,
                  const Tuple& tuple,
                  double pixel_stddev,
                  Eigen::Vector3d* position);

/// The least cost of all divisions, by looking at each point that is possible: the same costs as
/// ViewAssociator, but no gate between pairs. For few spots only.
Division bestDivision(const geometry::Rig& rig,
                      const SimulatedViews& views,
                      const AssociationOptions& options);

/// All cameras see all LEDs and nothing else: the best of all permutations, by the sum of chi^2.
Division bestPermutation(const geometry::Rig& rig,
                         const SimulatedViews& views,
                         const AssociationOptions& options);

/// What an associator found, to be compared.
Division divisionOf(const Association& association, std::size_t cameras);

}  // namespace wiimote_tracker::association::test

#endif  // WIIMOTE_TRACKER_TRIANGULATION_TEST_ASSOCIATION_EXHAUSTIVE_H
