#pragma once

#include "wiimote_tracker_triangulation/geometry/camera.h"
#include "wiimote_tracker_triangulation/geometry/sight.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::geometry {

/// One camera's view of the point.
struct Observation {
  const Camera* camera = nullptr;  ///< Not owned.
  Eigen::Vector2d pixel;           ///< As observed, distorted [px].
};

enum class TriangulationMethod {
  kMeanClosest,         ///< Mean of the closest points of all ray pairs (the paper, section IV.B);
                        ///< pairs below minimum_angle are left out.
  kLeastSquares,        ///< Point with the least sum of squared distances to all rays.
  kMaximumLikelihood,   ///< Least sum of squared pixel residuals (Gauss-Newton).
  kReweightedMidpoint,  ///< kLeastSquares, then again with distances weighted by the range of the
                        ///< first point: close to kMaximumLikelihood, in closed form.
};

struct TriangulationOptions {
  TriangulationMethod method = TriangulationMethod::kMaximumLikelihood;
  double pixel_stddev = 0.5;    ///< Of each pixel coordinate [px, > 0]; scales the covariance.
  double minimum_angle = 0.02;  ///< Largest angle between any two rays must reach this [rad].
};

struct TriangulatedPoint {
  Eigen::Vector3d position;    ///< World [m].
  Eigen::Matrix3d covariance;  ///< World [m^2], of the chosen method, for exact cameras.
  double reprojection_error;   ///< sqrt(mean(du^2 + dv^2)) over the observations [px].
};

/// Point from two or more observations of exact cameras, whose pixel noise is Gaussian, independent
/// and equal in both axes. Does not allocate for up to 16 observations.
/// @returns nothing when it is not determined: fewer than two observations, all rays (nearly)
/// parallel, a pixel without a ray, the point behind any of the cameras, not finite. The covariance
/// is propagated from that noise to first order, whatever the method.
std::optional<TriangulatedPoint> triangulate(const std::vector<Observation>& observations,
                                             const TriangulationOptions& options);

/// Same from sights, for callers that use each of them more than once; reprojection_error is the
/// linearised one (see Sight). Never allocates.
std::optional<TriangulatedPoint> triangulate(const Sight* sights,
                                             std::size_t count,
                                             const TriangulationOptions& options);

}  // namespace wiimote_tracker::geometry
