#pragma once

#include "wiimote_tracker_triangulation/geometry/linear_algebra.h"

namespace wiimote_tracker::geometry::test {

/// The lower triangular L with L L^T = covariance (positive definite): L z has this covariance
/// where the components of z are independent with variance one.
Eigen::MatrixXd rootOf(const AnyMatrix& covariance);

/// How far the spread of drawn errors is from a covariance: whitened by it, the spread would be the
/// identity, from which this is the largest difference of an element.
double whitenedDifference(const AnyMatrix& spread, const AnyMatrix& covariance);

double leastEigenvalue(const AnyMatrix& symmetric);

}  // namespace wiimote_tracker::geometry::test
