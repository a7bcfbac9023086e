#include "place/check_place.h"

#include "adjust/chi_squared.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>

#include <cmath>

namespace wiimote_tracker::place {

namespace {

/// Which cameras do not fit together, and what to do about it.
std::string contradiction(const MeasuredPlace& measured) {
  if (!measured.suspects.empty())
    return joined(measured.suspects, " or ") +
           " contradicts the other cameras: it was moved, or sees another light; clear that up, "
           "then " +
           measured.remedy;
  std::vector<std::string> misses;
  for (const CameraResidual& each : measured.residuals)
    misses.push_back(each.camera + format(" by %.1f px", each.residual.norm()));
  return "the rays of the cameras miss each other (" + joined(misses) +
         "): one was moved, or they see different lights; clear that up, then " + measured.remedy;
}

std::string advice(const MeasuredPlace& measured, bool consistent) {
  if (!measured.rays_agree)
    return contradiction(measured);
  if (consistent)
    return "the calibration holds";
  if (!measured.calibration_known)
    return "the rig does not say how certain its cameras are, so only the pixels' noise was "
           "expected: compare the error with what you need";
  return "that is too much: check the place and its coordinates [m], and calibrate again if they "
         "are right";
}

}  // namespace

void requirePlace(const Eigen::Vector3d& known, double known_stddev) {
  if (!known.allFinite())
    throw Error("the known place is not finite: give x, y and z in metres");
  if (!(known_stddev >= 0.0) || !std::isfinite(known_stddev))
    throw Error("known_stddev must be 0 or above: give it in metres");
}

PlaceCheck checkPlace(const MeasuredPlace& measured,
                      const Eigen::Vector3d& known,
                      double known_stddev) {
  const Eigen::Vector3d difference = measured.position - known;
  const Eigen::Matrix3d covariance =
      measured.covariance + known_stddev * known_stddev * Eigen::Matrix3d::Identity();
  PlaceCheck check;
  check.error = difference.norm();
  check.expected_stddev = std::sqrt(covariance.trace());
  check.consistent = geometry::squaredMahalanobis(difference, covariance) <=
                     adjust::chiSquaredQuantile(3, adjust::kTwoNines);
  check.message =
      format(
          "measured %.1f mm from the known place, where %.1f mm (one standard deviation) are to "
          "be expected: ",
          1000.0 * check.error, 1000.0 * check.expected_stddev) +
      advice(measured, check.consistent);
  return check;
}

}  // namespace wiimote_tracker::place
