#include "wiimote_tracker_calibration/intrinsics/solve_intrinsics.h"

#include "lens_fit.h"
#include "view_geometry.h"

#include "adjust/opencv.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::intrinsics {

namespace {

constexpr double kSmallestTilt = 10.0 * M_PI / 180.0;  // between the most different views
constexpr double kSmallestTravel = 0.1;                // of the board, of the image's width
// Of a pixel coordinate: an LED 0.5 mm beside its place on the board, 0.7 m away [px].
constexpr double kUsualPixelStddev = 1.0;

/// Whether the lens is one-to-one over the whole image.
bool holds(const Fit& fit, const Points& points) {
  const geometry::Intrinsics intrinsics = intrinsicsOf(fit, points);
  for (const double u : {0.0, intrinsics.width - 1.0}) {
    for (const double v : {0.0, intrinsics.height - 1.0}) {
      if (!intrinsics.normalizedFromPixel({u, v}))
        return false;
    }
  }
  return true;
}

/// Bayesian information criterion (Schwarz 1978): low is good.
double bicOf(const Fit& fit, const Points& points) {
  const double n = 2.0 * static_cast<double>(points.count);
  const double parameters =
      parameterCount(fit.model) + kPoseParameters * static_cast<double>(points.board.size());
  // Residuals below a millionth of a pixel are rounding errors: they justify no parameter.
  const double variance = std::max(fit.error * fit.error / 2.0, 1e-12);
  return n * std::log(variance) + parameters * std::log(n);
}

/// Inverse information of the intrinsics, poses eliminated (Schur complement), for unit noise.
/// Nothing when it is singular.
std::optional<Eigen::MatrixXd> unitCovariance(const Fit& fit, const Points& points) {
  const int size = parameterCount(fit.model);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t view = 0; view < points.board.size(); ++view) {
    const ViewDerivative by = differentiate(fit, points, view);
    const Eigen::MatrixXd cross = by.pose.transpose() * by.lens;
    const Eigen::MatrixXd poses = by.pose.transpose() * by.pose;
    information +=
        by.lens.transpose() * by.lens - cross.transpose() * geometry::solveSymmetric(poses, cross);
  }
  return geometry::inverseOfInformation(information);
}

/// Checks that the board was shown at different places of the image.
void checkTravel(const Samples& samples) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(HUGE_VAL);
  Eigen::Vector2d high = -low;
  for (std::size_t i = 0; i < samples.views.size(); ++i) {
    const Eigen::Vector2d center =
        viewGeometry(samples.board, samples.views[i], "view " + std::to_string(i + 1)).center();
    low = low.cwiseMin(center);
    high = high.cwiseMax(center);
  }
  if ((high - low).maxCoeff() < kSmallestTravel * samples.width)
    throw Error(
        "all views show the board at one place of the image: show it in the "
        "corners of the image too");
}

/// Checks that the views have different tilts: otherwise the focal length is not determined.
void checkTilts(const Fit& fit) {
  std::vector<Eigen::Vector3d> normals;
  for (const cv::Mat& rotation : fit.rotations)
    normals.emplace_back(geometry::so3::exp(adjust::vectorFromCv(rotation)) *
                         Eigen::Vector3d::UnitZ());
  double most = 0.0;
  for (const Eigen::Vector3d& a : normals) {
    for (const Eigen::Vector3d& b : normals)
      most = std::max(most, std::acos(std::clamp(a.dot(b), -1.0, 1.0)));
  }
  if (most < kSmallestTilt)
    throw Error(
        "all views show the board from its front or under one tilt, which leaves "
        "the focal length open: tilt it by 30 to 45 degrees, to all sides");
}

std::string summaryOf(const IntrinsicsSolution& s) {
  const Eigen::Matrix<double, 9, 1> stddev = s.covariance.diagonal().cwiseSqrt();
  const char* const doubt = s.pixel_stddev > kUsualPixelStddev
                                ? "; that is much: check that the board is flat and its LEDs in "
                                  "place, cover other lights, "
                                  "and show it again"
                                : "";
  return format(
      "%zu views, %s: fx %.1f +- %.1f, fy %.1f +- %.1f, cx %.1f +- %.1f, cy %.1f +- %.1f "
      "px; reprojection error %.2f px%s",
      s.camera_from_board.size(), nameOf(s.model).c_str(), s.intrinsics.fx, stddev(0),
      s.intrinsics.fy, stddev(1), s.intrinsics.cx, stddev(2), s.intrinsics.cy, stddev(3),
      s.reprojection_error, doubt);
}

/// Fits the models from simple to rich, each starting from the one before, up to options.model.
Fit chooseModel(const Points& points, const SolverOptions& options) {
  Fit fit = firstFit(points, false, options.start_focal_length);
  checkTilts(fit);
  Fit chosen;
  double least_bic = HUGE_VAL;
  double least_error = HUGE_VAL;  // of those that do not hold [px]
  for (const LensModel model :
       {LensModel::kNoDistortion, LensModel::kK1, LensModel::kK1K2, LensModel::kFull}) {
    if (model != LensModel::kNoDistortion) {
      const Fit next = refined(fit, model, points);
      if (!next.ok())
        continue;
      fit = next;
    }
    const double bic = bicOf(fit, points);
    if (!holds(fit, points)) {
      least_error = std::min(least_error, fit.error);
    } else if (options.model ? model == *options.model : bic < least_bic) {
      least_bic = bic;
      chosen = fit;
    }
    if (model == options.model)
      break;
  }
  // If a model that is not one-to-one over the image fits far better, the chosen one is poor.
  constexpr double kMuchBetter = 0.7;
  const bool is_makeshift = !options.model && least_error < kMuchBetter * chosen.error;
  if (!chosen.ok() || is_makeshift)
    throw Error(
        "the lens model does not hold over the whole image: show the board in "
        "all corners of the image, or choose a simpler model, or equidistant for a wide-angle "
        "lens");
  return chosen;
}

Fit fitEquidistant(const Points& points, const SolverOptions& options) {
  const Fit first = firstFit(points, true, options.start_focal_length);
  checkTilts(first);
  const Fit fit = refined(first, LensModel::kEquidistant, points);
  if (!fit.ok())
    throw Error(
        "the views fit no equidistant lens: check the board's spacings, show it in all corners of "
        "the image, or choose another model");
  if (!holds(fit, points))
    throw Error(
        "the equidistant lens does not hold over the whole image: show the board in all corners of "
        "the image, or choose another model");
  return fit;
}

}  // namespace

std::string nameOf(LensModel model) {
  // In the order of LensModel.
  constexpr const char* kNames[] = {"no distortion", "k1", "k1, k2", "k1, k2, p1, p2, k3",
                                    "equidistant k1, k2, k3, k4"};
  return kNames[static_cast<std::size_t>(model)];
}

IntrinsicsSolution solveIntrinsics(const Samples& samples, const SolverOptions& options) {
  if (samples.views.size() < static_cast<std::size_t>(options.minimum_views))
    throw Error(format("%s of the board, at least %d are needed: show it from more sides",
                       counted(samples.views.size(), "view").c_str(), options.minimum_views));
  checkTravel(samples);
  const Points points(samples);
  const Fit chosen = options.model == LensModel::kEquidistant ? fitEquidistant(points, options)
                                                              : chooseModel(points, options);

  IntrinsicsSolution solution;
  solution.model = chosen.model;
  solution.intrinsics = intrinsicsOf(chosen, points);
  solution.reprojection_error = chosen.error;
  const int parameters = parameterCount(chosen.model);
  const double degrees_of_freedom = 2.0 * static_cast<double>(points.count) - parameters -
                                    kPoseParameters * static_cast<double>(samples.views.size());
  solution.pixel_stddev =
      chosen.error * std::sqrt(static_cast<double>(points.count) / degrees_of_freedom);
  if (!(solution.pixel_stddev <= options.maximum_pixel_stddev))
    throw Error(
        format("the views do not fit the board (%.1f px): check its spacings, that it is "
               "flat, that it was held still, and that no other light was in view",
               solution.pixel_stddev));

  const auto covariance = unitCovariance(chosen, points);
  const double f = solution.intrinsics.fx;
  const double variance = solution.pixel_stddev * solution.pixel_stddev;
  if (!covariance ||
      !(std::sqrt(variance * (*covariance)(0, 0)) <= options.maximum_focal_stddev * f))
    throw Error(
        "the views leave the focal length too uncertain: show the board nearer, "
        "and tilted by 30 to 45 degrees to all sides");
  if (!(std::abs(f / solution.intrinsics.fy - 1.0) <= options.maximum_aspect_error))
    throw Error(
        "the focal lengths along x and y differ by more than a camera's do: the "
        "board's column and row spacing must be as measured");
  solution.covariance.topLeftCorner(parameters, parameters) = variance * *covariance;
  for (std::size_t i = 0; i < samples.views.size(); ++i)
    solution.camera_from_board.push_back(
        adjust::poseFromCv(chosen.rotations[i], chosen.translations[i]));
  solution.summary = summaryOf(solution);
  return solution;
}

}  // namespace wiimote_tracker::intrinsics
