#pragma once

#include "samples/grade.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::samples {

/// How well one camera was calibrated. Fields as in CameraVerdict.msg: standard deviations are 0
/// where held fixed, NaN is unknown. The residuals of a wave and of self_calibrate are corrected
/// for the parameters that were fitted.
struct CameraVerdict {
  std::string name;
  double residual_px = 0.0;             ///< RMS over both axes together [px].
  double residual_m = 0.0;              ///< At the distance of the points [m].
  double inlier_share = 0.0;            ///< Of its observations [0..1].
  double rotation_stddev = 0.0;         ///< Root of the trace [rad].
  double position_stddev = 0.0;         ///< Root of the trace [m].
  double focal_stddev = 0.0;            ///< The larger of both axes [px].
  double principal_point_stddev = 0.0;  ///< The larger of both axes [px].
  double k1_stddev = 0.0;               ///< [1]
  double time_offset_stddev = 0.0;      ///< [s]
};

/// A further measurement.
struct NextMeasurement {
  /// Between which a length is to be taken by tape, 0..3.
  std::optional<std::array<std::size_t, 2>> corners;
  /// Near which the LED is to be put on a known place, world [m].
  std::optional<Eigen::Vector3d> place;
  double expected_error = 0.0;  ///< After it, as Verdict::expected_error [m].
  std::string text;             ///< What to do and what it gains, one sentence.
};

/// How good a rig is, in numbers and in words. Fields as in CalibrationVerdict.msg.
struct Verdict {
  Grade grade = Grade::kRedo;
  std::string text;                        ///< Grade, reason, what to do.
  std::optional<std::size_t> redo_corner;  ///< To be captured again, 0..3.
  bool doubts_scale = false;               ///< The text asks whether lengths are in metres.
  std::vector<CameraVerdict> cameras;      ///< In the order of the rig.
  /// The corners of the square, then the places 2.5 m above them, world [m]; empty without square.
  std::vector<Eigen::Vector3d> predicted_at;
  /// Standard deviation (root of the trace) of a point triangulated there by all cameras that see
  /// it, from the joint covariance of the rig [m]. NaN where fewer than two cameras see it, or the
  /// rays are not those of the calibration.
  std::vector<double> predicted_stddev;
  double expected_error = kUnknown;     ///< RMS of those that are known [m].
  std::optional<NextMeasurement> next;  ///< That would lower it most.

  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace wiimote_tracker::samples
