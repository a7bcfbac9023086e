#pragma once

#include "association/point_search.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/geometry/sight.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <Eigen/Core>
#include <boost/container/small_vector.hpp>

#include <cstddef>
#include <vector>

namespace wiimote_tracker::association {

/// Costs of an S-D assignment, -2 log of the likelihood of spots, points and misses relative to
/// that of a detection at its predicted pixel (Deb, Yeddanapudi, Pattipati and Bar-Shalom 1997),
/// for Poisson numbers of LEDs (0.25 per m^3) and of false detections (ghost_rate per image), and
/// cameras that detect an LED in their view with detection_probability. With pixel_stddev = s [px],
///   ghost = -2 log(2 pi s^2 ghost_rate / mean image area of the rig),
///   miss = -2 log((1 - detection_probability) / detection_probability),
///   point = -2 log(0.25 (2 pi)^(3/2) v), the place integrated out (Laplace's approximation); v is
/// the square root of the determinant of the covariance of a typical point, (3.4 mm / px * s)^3 in
/// a cube of 2.5 m; at least 1, 0 and 0. All cameras have the same costs: images of twice the mean
/// area are off by 1.4, a ghost costs about 31.
AssociationOptions typicalCosts(const geometry::Rig& rig,
                                double pixel_stddev,
                                double ghost_rate = 0.1,
                                double detection_probability = 0.9);

struct SpotReference {
  std::size_t view;
  std::size_t spot;
};

/// More than 32 allocate.
using SpotReferences = boost::container::small_vector<SpotReference, 32>;

struct AssociatedPoint {
  geometry::TriangulatedPoint point;  ///< Maximum likelihood, linearised (see geometry::Sight).
  SpotReferences spots;               ///< In the order of the views.
};

struct Association {
  std::vector<AssociatedPoint> points;  ///< In the order of their first spots.
  double cost = 0.0;                    ///< Of the points and of all spots that belong to none.
  bool proven = true;                   ///< No other association costs less.
  std::size_t steps = 0;                ///< Of the search.
};

/// Associates the spots of several cameras at one time with points. A point has at most one spot
/// per camera; a spot of no point is a false detection. The association has the least sum of
///   point: chi^2 of its pixels + AssociationOptions::point + ::miss for each camera that has it in
///          view (Camera::sees), is watching and not full, and has no spot of it;
///   false detection: AssociationOptions::ghost.
/// Exact, by branch and bound: chi^2 only grows with every spot that is added to a point, and
/// components of spots that no possible pair connects are solved separately. Does not allocate once
/// warm.
class ViewAssociator {
 public:
  /// @param rig copied. @param partners for each camera the others that can see a point together
  /// with it, ascending and mutual (see geometry::sharedViews).
  ViewAssociator(const geometry::Rig& rig,
                 std::vector<std::vector<std::size_t>> partners,
                 const AssociationOptions& options);

  /// @param views one per camera of the rig, in its order. Valid until the next call.
  const Association& associate(const std::vector<View>& views);

 private:
  /// One of the two spots of an epipolar constraint.
  struct EpipolarSpot {
    Eigen::Vector3d direction;
    Eigen::Matrix<double, 3, 2> direction_by_pixel;  // for one standard deviation
    double spread;                                   // upper bound of its squared length
  };

  void collectSpots(const std::vector<View>& views);
  void findPairs(const std::vector<View>& views, std::size_t a, std::size_t b);
  void solveComponents(const std::vector<View>& views);
  void solveComponent(const std::vector<View>& views);

  AssociationOptions options_;
  PointSearch search_;
  std::vector<std::size_t> first_spot_;   // of each view, and one past the last of all
  std::vector<Component::Spot> spots_;    // of all views
  std::vector<EpipolarSpot> epipolar_;    // of all spots
  std::vector<double> pair_chi_squared_;  // see Component
  std::vector<bool> is_solved_;           // per spot
  std::vector<std::size_t> connected_;    // numbers of the spots of a component
  std::vector<Eigen::Vector3d> normals_;
  Component component_;
  Association result_;
};

}  // namespace wiimote_tracker::association
