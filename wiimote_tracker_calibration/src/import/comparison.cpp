#include "wiimote_tracker_calibration/import/comparison.h"

#include "remap/fit_model.h"
#include "wiimote_tracker_calibration/bundle/similarity.h"
#include "wiimote_tracker_calibration/import/pinhole.h"

#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/remap/model_math.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace wiimote_tracker::import {

namespace {

using bundle::kOutlier;
using bundle::Statistics;

using Points = std::vector<Eigen::Vector3d>;

Statistics distancesBetween(const Points& a, const Points& b) {
  std::vector<double> distances;
  for (std::size_t i = 0; i < a.size(); ++i)
    distances.push_back((a[i] - b[i]).norm());
  return bundle::statisticsOf(distances);
}

Points move(const Eigen::Affine3d& similarity, const Points& points) {
  Points moved;
  for (const Eigen::Vector3d& point : points)
    moved.push_back(similarity * point);
  return moved;
}

/// Nothing when the points do not determine it.
std::optional<remap::Remap> fitProjective(const Points& from, const Points& to) {
  std::vector<remap::KnownPoint> points;
  for (std::size_t i = 0; i < from.size(); ++i)
    points.push_back({from[i], to[i]});
  return remap::fitParameters(remap::Model::kProjective, points);
}

Points project(const std::optional<remap::Remap>& projective, const Points& points) {
  Points moved(points.size(), Eigen::Vector3d::Constant(kOutlier));
  if (!projective)
    return moved;
  const remap::Frame frame = remap::frameOf(projective->support);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (const auto mapped = remap::evaluate(*projective, frame, points[i]))
      moved[i] = mapped->position;
  }
  return moved;
}

/// Fits a transformation twice, the second time without the tenth that fits worst.
template <typename Fit, typename Apply>
Points aligned(const Points& from, const Points& to, const Fit& fit, const Apply& apply) {
  Points moved = apply(fit(from, to), from);
  std::vector<std::size_t> order(from.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return (moved[a] - to[a]).norm() < (moved[b] - to[b]).norm();
  });
  Points good_from;
  Points good_to;
  for (std::size_t i = 0; i < (9 * order.size() + 9) / 10; ++i) {
    good_from.push_back(from[order[i]]);
    good_to.push_back(to[order[i]]);
  }
  return apply(fit(good_from, good_to), from);
}

void comparePoints(const bundle::Reconstruction& own,
                   const bundle::Reconstruction& shipped,
                   const std::optional<double>& expected,
                   Comparison* comparison) {
  Points from;
  Points to;
  for (std::size_t i = 0; i < own.points.size(); ++i) {
    if (own.points[i] && shipped.points[i]) {
      from.push_back(*own.points[i]);
      to.push_back(*shipped.points[i]);
    }
  }
  comparison->points = from.size();
  if (from.size() < 10)
    return;
  const Points similar = aligned(from, to, bundle::fitSimilarity, move);
  comparison->similar = distancesBetween(similar, to);
  comparison->projective = distancesBetween(aligned(similar, to, fitProjective, project), to);
  comparison->extent = geometry::spreadOf(to).norm();
  if (expected)
    comparison->expected =
        *expected * std::cbrt(bundle::fitSimilarity(from, to).linear().determinant());
}

/// Errors of the own solution in the undistorted pixels of the shipped matrices.
std::vector<Statistics> rectifiedErrors(const bundle::Reconstruction& own,
                                        const ShippedCameras& shipped,
                                        double maximum_error) {
  std::vector<std::vector<double>> errors(own.cameras.size());
  for (const bundle::Observation& observation : own.observations) {
    const auto& rectify = shipped.rectifications[observation.camera];
    const auto& point = own.points[observation.point];
    const auto seen = rectify(observation.pixel);
    const auto projected = point ? own.cameras[observation.camera].project(*point) : std::nullopt;
    const auto expected = projected ? rectify(*projected) : std::nullopt;
    const double error = seen && expected ? (*seen - *expected).norm() : kOutlier;
    errors[observation.camera].push_back(error <= maximum_error ? error : kOutlier);
  }
  std::vector<Statistics> result;
  for (const std::vector<double>& of_camera : errors)
    result.push_back(bundle::statisticsOf(of_camera));
  return result;
}

/// The shipped cameras with the shipped intrinsics. Nothing if the matrices have other intrinsics,
/// or skew.
std::optional<bundle::Reconstruction> withLenses(const Recording& recording,
                                                 const ShippedCameras& shipped,
                                                 const bundle::Reconstruction& own,
                                                 const bundle::Options& options) {
  const double kEqual = 1e-6;
  bundle::Reconstruction result = own;
  for (std::size_t i = 0; i < recording.cameras.size(); ++i) {
    const geometry::Intrinsics& lens = recording.cameras[i].intrinsics;
    const Pinhole& pinhole = shipped.rectifications[i].pinhole();
    Eigen::Matrix<double, 5, 1> difference;
    difference << pinhole.fx - lens.fx, pinhole.fy - lens.fy, pinhole.cx - lens.cx,
        pinhole.cy - lens.cy, pinhole.skew;
    if (difference.norm() > kEqual * lens.fx)
      return std::nullopt;
    result.cameras[i].intrinsics = lens;
    result.cameras[i].world_from_camera = pinhole.world_from_camera;
  }
  bundle::triangulatePoints(&result, options.maximum_error);
  return result;
}

}  // namespace

std::optional<Comparison> compare(const Recording& recording,
                                  const bundle::SelfCalibration& solution,
                                  const bundle::Options& options) {
  const auto all = [&](const auto& has) {
    return std::all_of(recording.cameras.begin(), recording.cameras.end(), has);
  };
  if (!all([](const RecordedCamera& camera) { return camera.has_intrinsics; }))
    return std::nullopt;
  const bundle::Reconstruction& own = solution.reconstruction;
  Comparison comparison;
  const auto compareWith = [&](const bundle::Reconstruction& shipped) {
    comparison.own = bundle::statisticsOfCameras(own);
    comparison.shipped = bundle::statisticsOfCameras(shipped);
    comparePoints(own, shipped, solution.expected_shape_error, &comparison);
  };
  if (all([](const RecordedCamera& camera) { return camera.projection.has_value(); })) {
    const ShippedCameras shipped = shippedCameras(recording, options);
    if (const auto same_pixels = withLenses(recording, shipped, own, options)) {
      comparison.what = "shipped lenses and poses; errors in pixels as recorded";
      compareWith(*same_pixels);
      return comparison;
    }
    comparison.what = "shipped projection matrices; errors in undistorted pixels";
    compareWith(shipped.reconstruction);
    comparison.own = rectifiedErrors(own, shipped, options.maximum_error);
    return comparison;
  }
  bundle::Reconstruction shipped = own;
  for (std::size_t i = 0; i < shipped.cameras.size(); ++i)
    shipped.cameras[i].intrinsics = recording.cameras[i].intrinsics;
  try {
    shipped = bundle::solve(shipped, options);
  } catch (const bundle::BundleError& error) {
    comparison.what = std::string("the shipped intrinsics lead to no solution: ") + error.what();
    return comparison;
  }
  comparison.what = "shipped intrinsics, poses solved with them; errors in pixels as recorded";
  compareWith(shipped);
  return comparison;
}

}  // namespace wiimote_tracker::import
