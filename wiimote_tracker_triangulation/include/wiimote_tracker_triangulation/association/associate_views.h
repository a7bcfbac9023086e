#ifndef WIIMOTE_TRACKER_TRIANGULATION_ASSOCIATION_ASSOCIATE_VIEWS_H
#define WIIMOTE_TRACKER_TRIANGULATION_ASSOCIATION_ASSOCIATE_VIEWS_H

#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/geometry/sight.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <cstddef>
#include <memory>
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

/// Costs for Poisson numbers of LEDs (0.25 per m^3) and of false detections (ghost_rate per image),
/// and cameras that detect an LED in their view with detection_probability. With pixel_stddev = s
/// [px],
///   ghost = -2 log(2 pi s^2 ghost_rate / mean image area of the rig),
///   miss = -2 log((1 - detection_probability) / detection_probability),
///   point = -2 log(0.25 (2 pi)^(3/2) v), v the square root of the determinant of the covariance
/// of a typical point, (3.4 mm / px * s)^3 in a cube of 2.5 m; at least 1, 0 and 0.
AssociationOptions typicalCosts(const geometry::Rig& rig,
                                double pixel_stddev,
                                double ghost_rate = 0.1,
                                double detection_probability = 0.9);

/// The spots of one camera.
struct View {
  const geometry::Sight* sights = nullptr;  ///< Not owned.
  std::size_t count = 0;
  bool watching = true;  ///< False: there is no image, so no detection is missed.
  bool full = false;     ///< As many spots as the camera can report: no detection counts as missed.
};

struct SpotReference {
  std::size_t view;
  std::size_t spot;
};

struct AssociatedPoint {
  geometry::TriangulatedPoint point;  ///< Maximum likelihood, linearised (see geometry::Sight).
  std::size_t first_spot;             ///< In Association::spots.
  std::size_t spot_count;
};

struct Association {
  std::vector<AssociatedPoint> points;  ///< In the order of their first spots.
  std::vector<SpotReference> spots;     ///< Of the points, each in the order of the views.
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
  /// with it, ascending and mutual (see sharedViews).
  ViewAssociator(const geometry::Rig& rig,
                 std::vector<std::vector<std::size_t>> partners,
                 const AssociationOptions& options);

  ~ViewAssociator();

  /// @param views one per camera of the rig, in its order. Valid until the next call.
  const Association& associate(const std::vector<View>& views);

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace wiimote_tracker::association

#endif  // WIIMOTE_TRACKER_TRIANGULATION_ASSOCIATION_ASSOCIATE_VIEWS_H
