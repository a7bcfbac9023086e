#pragma once

#include <Eigen/Geometry>

#include <optional>
#include <vector>

/// Linear algebra that many files need. Eigen compiles a decomposition anew in every file that uses
/// it, which takes 3 to 26 s each; these are compiled once. Not for the hot path: they allocate.
namespace wiimote_tracker::geometry {

using AnyMatrix = Eigen::Ref<const Eigen::MatrixXd>;
using AnyVector = Eigen::Ref<const Eigen::VectorXd>;

/// J C J^T, the covariance of what changes by J with errors of covariance C; exactly symmetric.
/// @param jacobian n x m. @param covariance m x m.
Eigen::MatrixXd propagated(const AnyMatrix& jacobian, const AnyMatrix& covariance);

/// Square of the Mahalanobis distance: error^T covariance^-1 error.
/// @param covariance n x n, positive definite.
double squaredMahalanobis(const AnyVector& error, const AnyMatrix& covariance);

/// matrix^-1 * right. @param matrix n x n, symmetric, positive definite. @param right n x m.
Eigen::MatrixXd solveSymmetric(const AnyMatrix& matrix, const AnyMatrix& right);

/// Moore-Penrose pseudo-inverse. Times a vector b it is the shortest x that minimises
/// |matrix x - b|. @param matrix n x m. @return m x n.
Eigen::MatrixXd pseudoInverse(const AnyMatrix& matrix);

/// Orthonormal columns that span what the given ones span. @param columns n x m, m <= n,
/// independent. @return n x m.
Eigen::MatrixXd orthonormalBasis(const AnyMatrix& columns);

/// Inverse of an information matrix whose parameters may have very different units. Nothing when it
/// is singular: a direction has less than 1e-13 of the information of another one.
/// @param information n x n, symmetric.
std::optional<Eigen::MatrixXd> inverseOfInformation(const AnyMatrix& information);

/// Standard deviations of points along their principal axes, the largest first [unit of the
/// points]. NaN where a coordinate is not finite.
Eigen::Vector3d spreadOf(const std::vector<Eigen::Vector3d>& points);

/// The pose of frame b in frame a that brings points known in both nearest to each other (least
/// squares; Umeyama 1991, without scale).
/// @param in_a, in_b as many points in both, finite, three or more, not on one line; otherwise the
/// rotation is arbitrary.
Eigen::Isometry3d rigidAlignment(const std::vector<Eigen::Vector3d>& in_a,
                                 const std::vector<Eigen::Vector3d>& in_b);

}  // namespace wiimote_tracker::geometry
