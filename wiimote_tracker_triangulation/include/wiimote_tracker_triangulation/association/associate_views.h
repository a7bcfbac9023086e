#ifndef WIIMOTE_TRACKER_TRIANGULATION_ASSOCIATION_ASSOCIATE_VIEWS_H
#define WIIMOTE_TRACKER_TRIANGULATION_ASSOCIATION_ASSOCIATE_VIEWS_H

#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/geometry/sight.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace wiimote_tracker::association {

/// Costs are -2 log likelihood, like chi^2. For the defaults see typicalCosts.
struct AssociationOptions {
  double pixel_stddev = 0.5;  ///< Of each pixel coordinate, the calibration's error included [px].
  double ghost = 31.0;        ///< A spot that belongs to no point [> 0].
  double point = 35.0;        ///< A point that exists [>= 0].
  double miss = 4.4;          ///< A camera that ought to see a point and does not [>= 0].

  /// Spots of two cameras whose rays miss each other by more than this can not be one point: the
  /// squared distance from the epipolar constraint, to first order, over pixel_stddev^2 [> 0].
  double maximum_pair_chi_squared = 30.0;

  std::size_t minimum_rays = 2;  ///< Of a point [>= 2].
  double minimum_angle = 0.02;   ///< Largest angle between any two rays of a point [rad].

  /// After this many steps the best points found are taken, proven or not.
  std::size_t maximum_steps = 5000;
};

/// Costs for Poisson numbers of LEDs (0.25 per m^3) and of ghosts (ghost_rate per image of 1024 x
/// 768 px), and cameras that show with detection_probability what they ought to see. With
/// pixel_stddev = s [px],
///   ghost = -2 log(2 pi s^2 ghost_rate / (1024 * 768)),
///   miss = -2 log((1 - detection_probability) / detection_probability),
///   point = -2 log(0.25 (2 pi)^(3/2) v), v the square root of the determinant of the covariance
/// of a typical point, (3.4 mm / px * s)^3 in a cube of 2.5 m; at least 1, 0 and 0.
AssociationOptions typicalCosts(double pixel_stddev,
                                double ghost_rate = 0.1,
                                double detection_probability = 0.9);

/// The spots of one camera.
struct View {
  const geometry::Sight* sights = nullptr;  ///< Not owned.
  std::size_t count = 0;
  bool watching = true;  ///< False: there is no image, so nothing was missed.
  bool full = false;     ///< As many spots as the camera can report: nothing was missed for sure.
};

struct SpotReference {
  std::size_t view;
  std::size_t spot;
};

struct AssociatedPoint {
  geometry::TriangulatedPoint point;  ///< Maximum likelihood, linearised (see geometry::Sight).
  double cost;                        ///< chi^2 + misses + AssociationOptions::point.
  std::size_t first_spot;             ///< In Association::spots.
  std::size_t spot_count;
};

struct Association {
  std::vector<AssociatedPoint> points;  ///< In the order of their first spots.
  std::vector<SpotReference> spots;     ///< Of the points, each in the order of the views.
  double cost = 0.0;                    ///< Of the points and of all spots that belong to none.
  bool proven = true;                   ///< No other association costs less.
  std::size_t steps = 0;                ///< Taken by the search.
};

/// Which spots of several cameras at one time are the same points? Of all ways to divide the spots
/// into points, of at most one spot per camera, and ghosts, the one with the least sum of
///   point: chi^2 of its pixels + AssociationOptions::point + ::miss for each camera that has it in
///          view (Camera::sees), is watching and not full, and has no spot of it;
///   ghost: AssociationOptions::ghost.
/// Exact, by branch and bound: chi^2 only grows with every spot that is added to a point, and
/// spots that no chain of possible pairs connects do not matter to each other. Does not allocate
/// once warm.
class ViewAssociator {
 public:
  /// @param rig for what is in view of whom; copied.
  /// @param partners for each camera the others that can see a point together with it, ascending
  /// and mutual (see sharedViews).
  ViewAssociator(const geometry::Rig& rig,
                 std::vector<std::vector<std::size_t>> partners,
                 const AssociationOptions& options);

  ~ViewAssociator();
  ViewAssociator(ViewAssociator&&) noexcept;
  ViewAssociator& operator=(ViewAssociator&&) noexcept;

  /// @param views one per camera of the rig, in its order. Valid until the next call.
  const Association& associate(const std::vector<View>& views);

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace wiimote_tracker::association

#endif  // WIIMOTE_TRACKER_TRIANGULATION_ASSOCIATION_ASSOCIATE_VIEWS_H
