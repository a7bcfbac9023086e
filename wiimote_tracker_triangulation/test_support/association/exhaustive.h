#pragma once

#include "association/associate_views.h"
#include "association/simulated_views.h"

#include <map>
#include <set>
#include <vector>

namespace wiimote_tracker::association::test {

/// Spots of a point: per camera the spot, or -1.
using Tuple = std::vector<int>;

/// All spots, divided into points and ghosts.
struct Division {
  std::set<Tuple> points;
  double cost = 0.0;
};

/// chi^2 of the point that fits the pixels of a tuple best: Gauss-Newton on the cameras'
/// projection, with its own initial point; infinite when there is none.
double chiSquared(const geometry::Rig& rig,
                  const SimulatedViews& views,
                  const Tuple& tuple,
                  double pixel_stddev,
                  Eigen::Vector3d* position);

/// The least cost of all divisions, by enumerating every possible point: ViewAssociator's costs
/// without its gate between pairs. For few spots only.
Division bestDivision(const geometry::Rig& rig,
                      const SimulatedViews& views,
                      const AssociationOptions& options);

/// The permutation with the least sum of chi^2, where all cameras see all LEDs and nothing else.
Division bestPermutation(const geometry::Rig& rig,
                         const SimulatedViews& views,
                         const AssociationOptions& options);

/// An associator's result, for comparison.
Division divisionOf(const Association& association, std::size_t cameras);

}  // namespace wiimote_tracker::association::test
