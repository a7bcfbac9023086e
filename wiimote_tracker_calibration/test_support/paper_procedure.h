#pragma once

#include "wiimote_tracker_calibration/principal_point/correction.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace wiimote_tracker::principal_point {

/// A simulated measurement session of the paper (section V.B): its cube, cameras, square and ten
/// points. The cameras start from the default intrinsics.
struct PaperSession {
  /// Of the four cameras round the cube, in their order: {0, 1} adjacent, {0, 2} diagonal.
  std::vector<std::size_t> cameras = {0, 1};
  CorrectionOptions correction;  ///< Ray model, rounds, step, points, method.
  std::uint64_t seed = 1;
};

/// Mean distance of the ten points from where they are [m].
struct PaperResult {
  double before = 0.0;
  double after = 0.0;
  CorrectionResult correction;
};

/// One session. Points are measured by the method of the correction.
/// @throws geometry::Error when a session cannot be solved, or a point not be measured.
PaperResult runPaperSession(const PaperSession& session);

}  // namespace wiimote_tracker::principal_point
