#include "wiimote_tracker_calibration/remap/fit.h"

#include "fit_model.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_msgs/median.h>
#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/remap/convex_hull.h>
#include <wiimote_tracker_triangulation/remap/model_math.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <optional>

namespace wiimote_tracker::remap {

namespace {

// Known points.
constexpr std::size_t kFewest = 6;
constexpr std::size_t kMost = 500;
// A standard deviation below this share of the largest means that the points are flat.
constexpr double kFlat = 0.03;
// Most groups of points that are held out for the expected error.
constexpr std::size_t kMostFolds = 20;
// A warning names a point whose error is more than this many times the median.
constexpr double kOutlier = 5.0;
// A point is inside if it is deeper in the hull than this, in half the longest edge of the volume.
constexpr double kInside = 0.1;

void checkSpread(const std::vector<Eigen::Vector3d>& points, const std::string& which) {
  const Eigen::Vector3d spread = geometry::spreadOf(points);
  if (spread[1] < kFlat * spread[0])
    throw Error("the " + which +
                " points lie on one line: add points to its sides and at other heights");
  if (spread[2] < kFlat * spread[0])
    throw Error("the " + which +
                " points lie in one plane: add points off it, for example at other heights");
}

/// @throws Error when no model at all can be fitted to the points.
void checkPoints(const std::vector<KnownPoint>& points) {
  if (points.size() < kFewest)
    throw Error("only " + counted(points.size(), "known point") +
                ", too few for any correction of the volume: measure at least "
                "6, better the 8 corners of the volume and some inside");
  if (points.size() > kMost)
    throw Error(std::to_string(points.size()) +
                " known points are more than can be handled: choose at most 500");
  std::vector<Eigen::Vector3d> known;
  std::vector<Eigen::Vector3d> measured;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const KnownPoint& point : points) {
    known.push_back(point.known);
    measured.push_back(point.measured);
    mean += point.measured / static_cast<double>(points.size());
  }
  checkSpread(known, "known");
  checkSpread(measured, "measured");
  Eigen::Matrix3d correlation = Eigen::Matrix3d::Zero();
  for (const KnownPoint& point : points)
    correlation += (point.measured - mean) * point.known.transpose();
  if (correlation.determinant() < 0.0)
    throw Error(
        "the measured points are the mirror image of the known ones: check the axes and the signs "
        "of the known places, and that none are exchanged");
}

Eigen::Map<const Eigen::ArrayXd> arrayOf(const std::vector<double>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

double rms(const std::vector<double>& errors) {
  return std::sqrt(arrayOf(errors).square().mean());
}

std::vector<double> uncorrectedErrors(const std::vector<KnownPoint>& points) {
  std::vector<double> errors;
  errors.reserve(points.size());
  for (const KnownPoint& point : points)
    errors.push_back((point.measured - point.known).norm());
  return errors;
}

std::string millimetres(double metres) {
  return format("%.1f mm", 1e3 * metres);
}

/// Whether the model's Jacobian determinant is positive everywhere in its support.
bool keepsOrientation(const Remap& remap) {
  const Frame frame = frameOf(remap.support);
  return std::all_of(remap.support.begin(), remap.support.end(), [&](const Eigen::Vector3d& point) {
    const auto mapped = evaluate(remap, frame, point);
    return mapped && mapped->jacobian.determinant() > 0.0;
  });
}

/// @returns nothing, and the reason, if the model cannot be used.
std::optional<FittedModel> tryModel(Model model,
                                    const std::vector<KnownPoint>& points,
                                    std::string* reason) {
  auto fitted = fitModel(model, points);
  if (!fitted)
    *reason = "the points do not determine it: spread them through the whole volume";
  else if (!keepsOrientation(fitted->remap))
    *reason = "it would fold the volume: check the points, and add some";
  else if (fitted->left_out_errors.empty())
    *reason = "without one of the points it is not determined: add points";
  else
    return fitted;
  return std::nullopt;
}

/// Whether the squared errors are smaller by more than the standard error of the difference.
bool isBetter(const std::vector<double>& errors, const std::vector<double>& than) {
  const auto n = static_cast<double>(errors.size());
  const Eigen::ArrayXd gain = arrayOf(than).square() - arrayOf(errors).square();
  return gain.mean() > std::sqrt((gain - gain.mean()).square().sum() / (n - 1.0) / n);
}

/// Index of the best candidate; nothing if no correction is as good.
std::optional<std::size_t> choose(const std::vector<std::optional<FittedModel>>& candidates,
                                  const std::vector<KnownPoint>& points) {
  std::optional<std::size_t> best;
  std::vector<double> least = uncorrectedErrors(points);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (candidates[i] && isBetter(candidates[i]->left_out_errors, least)) {
      best = i;
      least = candidates[i]->left_out_errors;
    }
  }
  return best;
}

/// RMS error of points that took part neither in the fit nor in the choice (nested
/// cross-validation).
double nestedError(const std::vector<KnownPoint>& points, const std::vector<Model>& models) {
  const std::size_t folds = std::min(points.size(), kMostFolds);
  std::vector<double> errors;
  for (std::size_t fold = 0; fold < folds; ++fold) {
    std::vector<KnownPoint> inside;
    std::vector<KnownPoint> held_out;
    for (std::size_t i = 0; i < points.size(); ++i)
      (i % folds == fold ? held_out : inside).push_back(points[i]);
    std::vector<std::optional<FittedModel>> candidates;
    candidates.reserve(models.size());
    std::string reason;
    for (const Model model : models)
      candidates.push_back(tryModel(model, inside, &reason));
    const std::optional<std::size_t> chosen = choose(candidates, inside);
    for (const KnownPoint& point : held_out)
      errors.push_back(chosen ? errorOf(candidates[*chosen]->remap, point)
                              : (point.measured - point.known).norm());
  }
  return rms(errors);
}

std::vector<std::string> suspectPoints(const std::vector<double>& errors) {
  std::vector<double> values = errors;
  const double median = medianOf(&values);
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (errors[i] > kOutlier * median && errors[i] > 1e-6)
      warnings.push_back("known point " + std::to_string(i + 1) + " is " + millimetres(errors[i]) +
                         " from where the others predict it; half of the others are within " +
                         millimetres(median) + ": check its place, and measure it again");
  }
  return warnings;
}

/// Whether a point lies well inside the others, so that left out points test the inside too.
bool reachInside(const std::vector<Eigen::Vector3d>& support) {
  const ConvexHull hull(support);
  const double depth = kInside * frameOf(support).scale;
  return std::any_of(support.begin(), support.end(),
                     [&](const Eigen::Vector3d& point) { return hull.excess(point) < -depth; });
}

}  // namespace

FitResult fitRemap(const std::vector<KnownPoint>& points,
                   const std::string& rig_id,
                   const std::vector<Model>& allowed) {
  checkPoints(points);
  std::vector<Model> models = allowed;
  if (models.empty())
    models = {Model::kAffine, Model::kProjective, Model::kTrilinear, Model::kThinPlate};
  std::sort(models.begin(), models.end());

  FitResult result;
  result.uncorrected_error = rms(uncorrectedErrors(points));
  std::vector<Model> usable;
  std::vector<std::optional<FittedModel>> candidates;
  for (const Model model : models) {
    ModelReport report;
    report.model = model;
    if (points.size() < minimumPoints(model)) {
      report.reason = "it needs " + std::to_string(minimumPoints(model)) + " points: add some";
    } else if (const auto candidate = tryModel(model, points, &report.reason)) {
      report.usable = true;
      std::vector<double> errors;
      errors.reserve(points.size());
      for (const KnownPoint& point : points)
        errors.push_back(errorOf(candidate->remap, point));
      report.fit_error = rms(errors);
      report.left_out_error = rms(candidate->left_out_errors);
      usable.push_back(model);
      candidates.push_back(candidate);
    }
    result.models.push_back(report);
  }
  if (usable.empty())
    throw Error("no correction of the volume can be fitted (" +
                std::string(nameOf(result.models.front().model)) + ": " +
                result.models.front().reason + ")");
  const std::optional<std::size_t> chosen = choose(candidates, points);
  if (!chosen)
    throw Error("no correction of the volume predicts the known points better than none does (" +
                millimetres(result.uncorrected_error) +
                " off): do without it, or measure more points, and each more exactly");
  result.remap = candidates[*chosen]->remap;
  result.remap.rig_id = rig_id;
  result.left_out_errors = candidates[*chosen]->left_out_errors;
  result.warnings = suspectPoints(result.left_out_errors);
  if (!reachInside(result.remap.support))
    result.warnings.push_back(
        "no known point lies inside the others, so that nothing is known of the error there: "
        "measure some inside the volume");
  result.expected_error = nestedError(points, usable);
  return result;
}

std::string table(const FitResult& result) {
  const double uncorrected = 1e3 * result.uncorrected_error;
  std::string text = format("%-12s %10s %14s\n", "model", "fit [mm]", "left out [mm]") +
                     format("%-12s %10.1f %14.1f\n", "none", uncorrected, uncorrected);
  for (const ModelReport& model : result.models)
    text += model.usable ? format("%-12s %10.1f %14.1f%s\n", nameOf(model.model),
                                  1e3 * model.fit_error, 1e3 * model.left_out_error,
                                  model.model == result.remap.model ? "  chosen" : "")
                         : format("%-12s %s\n", nameOf(model.model), model.reason.c_str());
  text += "expected error of a corrected point: " + millimetres(result.expected_error) + "\n";
  return text;
}

}  // namespace wiimote_tracker::remap
