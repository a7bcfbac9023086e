#pragma once

#include <Eigen/Core>

#include <vector>

namespace wiimote_tracker::remap {

/// Exact convex hull of points, as the half spaces of its faces.
class ConvexHull {
 public:
  ConvexHull() = default;

  /// Takes time in the third power of the number of points, at worst the fourth; milliseconds for
  /// 100 points. Points in one plane have no volume: nothing is inside.
  explicit ConvexHull(const std::vector<Eigen::Vector3d>& points);

  /// Whether a point is inside or on the surface (relative tolerance 1e-9). Never allocates.
  bool encloses(const Eigen::Vector3d& point) const;

  /// Greatest signed distance of a point from the planes of the faces [m]: at most 0 inside, and
  /// never more than the distance to the hull. Infinite for a hull without volume.
  double excess(const Eigen::Vector3d& point) const;

  /// Where a segment leaves the hull.
  struct Exit {
    double share;            ///< Position on the segment [0..1].
    Eigen::Vector3d normal;  ///< Outward unit normal of the face it crosses.
  };

  /// @param inside a point inside. @param outside a point that is not enclosed. Requires a hull
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
