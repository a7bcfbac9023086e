#pragma once

#include "wiimote_tracker_calibration/bundle/self_calibrate.h"
#include "wiimote_tracker_calibration/import/comparison.h"

#include <cstdio>
#include <optional>
#include <string>

namespace wiimote_tracker::self_calibrate {

/// Results of self_calibrate.
struct Report {
  std::string source;  ///< Where the pixels are from.
  std::size_t frames = 0;
  bool lenses_given = false;
  bundle::SelfCalibration solution;
  std::optional<import::Comparison> comparison;
};

/// Text tables. @param points also the 3D points, one per line.
void print(const Report& report, bool points, std::FILE* file);

/// The same figures, all cameras and all points, as JSON.
std::string jsonText(const Report& report);

}  // namespace wiimote_tracker::self_calibrate
