#pragma once

#include "wiimote_tracker_calibration/bundle/reconstruction.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_triangulation/geometry/camera.h>
#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::import {

/// A recording cannot be read or used. what() names the file, and line or row and column where
/// there are any, in one sentence.
struct ImportError : Error {
  using Error::Error;
};

using NumberTable = std::vector<std::vector<double>>;  ///< Rows of equal length.

/// Numbers separated by blanks, one row per line; NaN is allowed, empty lines and what follows a #
/// (the headers of Octave) are skipped. The size must be rows x columns; 0 allows any.
/// @throws ImportError: missing, empty, not a number, infinite, rows of different length, another
/// size.
NumberTable readNumberTable(const std::string& path, std::size_t rows = 0, std::size_t columns = 0);

/// Lines that are not empty, without blanks at their ends. @throws ImportError: missing.
std::vector<std::string> readLines(const std::string& path);

bool fileExists(const std::string& path);

/// The whole text as a number; nothing else may follow. @throws ImportError naming `where`.
double parseNumber(const std::string& text, const std::string& where);

using ProjectionMatrix = Eigen::Matrix<double, 3, 4>;
using Pixels = std::vector<std::optional<Eigen::Vector2d>>;  ///< Per camera [px]; nothing: unseen.

struct RecordedCamera {
  std::string name;                            ///< Fit for a ROS name.
  geometry::Intrinsics intrinsics;             ///< Of basenameN.rad and Res.dat.
  bool has_intrinsics = true;                  ///< False: there is no basenameN.rad, only a size.
  std::optional<ProjectionMatrix> projection;  ///< World to undistorted pixels.
  std::optional<Eigen::Vector3d> center;       ///< As shipped [m].
};

/// What synchronised cameras saw of one moving light, and what was shipped with it.
struct Recording {
  std::vector<RecordedCamera> cameras;
  std::vector<Pixels> frames;
  std::vector<Eigen::Vector3d> points;  ///< One per frame, frame of the centres [m]; or empty.
};

/// Reads a folder in the layout of MultiCamSelfCal (points.dat) or flydra (camN.points4cal.dat);
/// see doc/self_calibrate.md. The unit of lengths is that of calibration_units.txt, else the metre.
/// A folder without any basenameN.rad is read only if intrinsics are not required.
/// @throws ImportError: a file is missing, damaged, or does not fit to the others.
Recording readRecording(const std::string& folder, bool intrinsics_required = true);

/// Cameras without poses, and what they saw: a point for each frame, not determined yet.
bundle::Reconstruction observedBy(const Recording& recording);

}  // namespace wiimote_tracker::import
