#ifndef WIIMOTE_TRACKER_TRIANGULATION_REMAP_CONVEX_HULL_H
#define WIIMOTE_TRACKER_TRIANGULATION_REMAP_CONVEX_HULL_H

#include <Eigen/Core>

#include <vector>

namespace wiimote_tracker::remap {

/// Exact convex hull of points, as the half spaces of its faces.
class ConvexHull {
 public:
  ConvexHull() = default;

  /// Time grows with the third power of the number of points, in the worst case with the fourth; a
  /// hundred take milliseconds. Points in one plane have no volume: nothing is inside.
  explicit ConvexHull(const std::vector<Eigen::Vector3d>& points);

  /// Whether a point is inside or on the surface (to a billionth of the size). Never allocates.
  bool encloses(const Eigen::Vector3d& point) const;

  /// How far the point is beyond the face it is farthest beyond [m]; at most 0 inside. Never more
  /// than the distance to the hull. Infinite for a hull without volume.
  double excess(const Eigen::Vector3d& point) const;

  /// Where a line leaves the hull.
  struct Exit {
    double share;            ///< Of the way that lies before it [0 to 1].
    Eigen::Vector3d normal;  ///< Of the face that it goes through: outwards, unit length.
  };

  /// @param inside a point of the inside, @param outside a point that is not enclosed. Of a hull
  /// with volume. Never allocates.
  Exit exit(const Eigen::Vector3d& inside, const Eigen::Vector3d& outside) const;

 private:
  struct Face {
    Eigen::Vector3d normal;  // Outwards, unit length.
    double offset;           // normal * point of the face [m].
  };

  std::vector<Face> faces_;
  double tolerance_ = 0.0;  // [m]
};

}  // namespace wiimote_tracker::remap

#endif  // WIIMOTE_TRACKER_TRIANGULATION_REMAP_CONVEX_HULL_H
