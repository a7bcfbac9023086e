#include "place/measure_place.h"

#include "adjust/chi_squared.h"
#include "health/remedy.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/triangulate.h>
#include <wiimote_tracker_triangulation/remap/correction.h>

#include <Eigen/LU>

#include <cstddef>
#include <optional>

namespace wiimote_tracker::place {

namespace {

/// One camera of the rig and what it saw.
struct View {
  std::size_t camera;
  Eigen::Vector2d pixel;
};

/// A point from some views, with the derivatives of its pixels.
struct Measurement {
  Eigen::Vector3d position;
  Eigen::VectorXd residuals;      // Two per view [px].
  Eigen::MatrixX3d by_point;      // Derivatives of the pixels, two rows per view.
  Eigen::MatrixXd by_parameters;  // Of all cameras of the rig.
};

std::optional<Measurement> measure(const geometry::Rig& rig,
                                   const std::vector<View>& views,
                                   double pixel_stddev) {
  std::vector<geometry::Camera> cameras;
  cameras.reserve(views.size());
  for (const View& view : views)
    cameras.push_back(rig.rayCamera(rig.cameras[view.camera]));
  std::vector<geometry::Observation> observations;
  for (std::size_t i = 0; i < views.size(); ++i)
    observations.push_back({&cameras[i], views[i].pixel});
  geometry::TriangulationOptions options;
  options.pixel_stddev = pixel_stddev;
  const auto point = geometry::triangulate(observations, options);
  if (!point)
    return std::nullopt;

  const auto rows = static_cast<Eigen::Index>(2 * views.size());
  Measurement result;
  result.position = point->position;
  result.residuals.resize(rows);
  result.by_point.resize(rows, 3);
  result.by_parameters = Eigen::MatrixXd::Zero(rows, geometry::firstParameter(rig.cameras.size()));
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto projection = geometry::rayProjection(rig, views[i].camera, point->position);
    if (!projection)
      return std::nullopt;
    const auto row = static_cast<Eigen::Index>(2 * i);
    result.residuals.segment<2>(row) = projection->pixel - views[i].pixel;
    result.by_point.middleRows<2>(row) = projection->by_point;
    result.by_parameters.block<2, geometry::kParameters>(
        row, geometry::firstParameter(views[i].camera)) = projection->by_parameters;
  }
  return result;
}

/// Covariance of the pixels' errors, including those of the calibration [px^2].
Eigen::MatrixXd pixelCovariance(const geometry::Rig& rig,
                                const Measurement& measurement,
                                double pixel_stddev) {
  const Eigen::Index rows = measurement.residuals.size();
  Eigen::MatrixXd covariance = pixel_stddev * pixel_stddev * Eigen::MatrixXd::Identity(rows, rows);
  if (geometry::hasCovariance(rig))
    covariance += geometry::propagated(measurement.by_parameters, rig.covariance);
  return covariance;
}

/// How far the rays miss each other: chi-squared of the residuals that the best point leaves
/// (generalised least squares), over its 99.9 % quantile.
double disagreement(const geometry::Rig& rig, const Measurement& measurement, double pixel_stddev) {
  const Eigen::MatrixXd covariance = pixelCovariance(rig, measurement, pixel_stddev);
  const Eigen::MatrixX3d weighed = geometry::solveSymmetric(covariance, measurement.by_point);
  const Eigen::Matrix3d information = measurement.by_point.transpose() * weighed;
  const Eigen::Vector3d step =
      information.inverse() * (weighed.transpose() * measurement.residuals);
  const double squared =
      geometry::squaredMahalanobis(measurement.residuals - measurement.by_point * step, covariance);
  const auto rows = static_cast<int>(measurement.residuals.size());
  return squared / adjust::chiSquaredQuantile(rows - 3, adjust::kThreeNines);
}

/// The cameras whose removal makes the others agree.
std::vector<std::string> suspectsOf(const geometry::Rig& rig,
                                    const std::vector<View>& views,
                                    double pixel_stddev) {
  std::vector<std::string> suspects;
  if (views.size() < 3)
    return suspects;
  for (std::size_t i = 0; i < views.size(); ++i) {
    std::vector<View> others = views;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const auto measurement = measure(rig, others, pixel_stddev);
    if (measurement && disagreement(rig, *measurement, pixel_stddev) <= 1.0)
      suspects.push_back(rig.cameras[views[i].camera].camera.name);
  }
  return suspects;
}

}  // namespace

MeasuredPlace measurePlace(const geometry::Rig& rig,
                           const capture::CapturedCorner& seen,
                           double pixel_stddev) {
  std::vector<View> views;
  std::vector<std::string> seeing;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const auto view = seen.find(rig.cameras[i].camera.name);
    if (view == seen.end())
      continue;
    views.push_back({i, view->second.pixel});
    seeing.push_back(view->first);
  }
  const std::string names = joined(seeing);
  if (views.size() < 2)
    throw Error("the LED was seen by " +
                (names.empty() ? "no camera of the rig" : names + " alone") +
                ", but two are needed: put it where two calibrated cameras see it");
  const auto measurement = measure(rig, views, pixel_stddev);
  if (!measurement)
    throw Error("the rays of " + names +
                " do not determine a point: they are nearly parallel, or meet behind a "
                "camera; check that they see the same LED, and calibrate again if they do");

  MeasuredPlace place;
  place.position = measurement->position;
  place.calibration_known = geometry::hasCovariance(rig);
  place.covariance = geometry::propagated(geometry::pseudoInverse(measurement->by_point),
                                          pixelCovariance(rig, *measurement, pixel_stddev));
  for (std::size_t i = 0; i < views.size(); ++i)
    place.residuals.push_back(
        {rig.cameras[views[i].camera].camera.name,
         measurement->residuals.segment<2>(static_cast<Eigen::Index>(2 * i))});
  place.rays_agree = disagreement(rig, *measurement, pixel_stddev) <= 1.0;
  if (!place.rays_agree)
    place.suspects = suspectsOf(rig, views, pixel_stddev);
  place.remedy = health::calibrateAgain(rig);
  return place;
}

MeasuredPlace corrected(const geometry::Rig& rig, MeasuredPlace place) {
  const std::string id = rig.id();
  if (!rig.remap || rig.remap->rig_id != id)
    return place;
  const auto point = remap::Correction(*rig.remap, id).apply(place.position, place.covariance);
  if (point) {
    place.position = point->position;
    place.covariance = point->covariance;
  }
  return place;
}

}  // namespace wiimote_tracker::place
