#pragma once

#include <wiimote_tracker_triangulation/remap/remap.h>

#include <Eigen/Core>

#include <string>
#include <vector>

namespace wiimote_tracker::remap {

/// A known place, and where the rig measured it.
struct KnownPoint {
  Eigen::Vector3d measured;  ///< World [m].
  Eigen::Vector3d known;     ///< World [m].
};

/// The result of one model.
struct ModelReport {
  Model model = Model::kAffine;
  bool usable = false;
  std::string reason;         ///< Why not, and what to do; empty when usable.
  double fit_error = 0.0;     ///< RMS distance from the known points, all of them fitted [m].
  double left_out_error = 0;  ///< RMS over the points, each predicted from all others [m].
};

/// A fitted correction, and its expected error.
struct FitResult {
  Remap remap;
  double uncorrected_error = 0.0;  ///< RMS distance from the known points before [m].
  /// Expected RMS error of a corrected point [m]: of points that took part neither in the fit nor
  /// in the choice of the model (nested cross-validation). It includes the errors of the known
  /// places, and tends to be too large, because a corner that is left out is extrapolated. It holds
  /// for places like the measured ones: points at the corners say nothing about the inside.
  double expected_error = 0.0;
  std::vector<ModelReport> models;      ///< Those allowed, the simplest first.
  std::vector<double> left_out_errors;  ///< Of the chosen model, per point [m].
  std::vector<std::string> warnings;    ///< One sentence each.
};

/// Fits each model, and chooses by leave-one-out cross-validation: the simplest, unless one with
/// more parameters predicts left out points better by more than the standard error of the
/// difference of their squared errors. The smoothing of a thin plate is chosen in the same way.
/// Takes milliseconds for tens of points, seconds for hundreds.
/// @param allowed models to choose from; empty: all.
/// @param points finite, no two known places the same. @param rig_id not empty.
/// @throws Error: fewer than 6 or more than 500 points, points on one line or in one plane;
/// mirrored; no model determined by the points, or none better than no correction.
FitResult fitRemap(const std::vector<KnownPoint>& points,
                   const std::string& rig_id,
                   const std::vector<Model>& allowed = {});

/// A text table of the models.
std::string table(const FitResult& result);

}  // namespace wiimote_tracker::remap
