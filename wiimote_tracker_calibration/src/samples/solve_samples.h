#pragma once

#include "samples/samples.h"
#include "samples/verdict.h"
#include "square/error.h"
#include "wiimote_tracker_calibration/principal_point/correction.h"
#include "wiimote_tracker_calibration/square/solve_square.h"
#include "wiimote_tracker_calibration/wave/solve_wave.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <cstddef>
#include <limits>
#include <optional>
#include <string>

namespace wiimote_tracker::samples {

struct SolveOptions {
  /// Its uncertainty also holds for the wave; so do uncertainty and branch odds for the correction.
  square::SolveOptions square;
  wave::WaveModel wave;
  /// Corrects the principal points as the paper does (section IV.C), for a square alone: a wave
  /// determines them itself.
  bool correct_principal_points = false;
  principal_point::CorrectionSteps correction;
  geometry::RayModel ray_model = geometry::RayModel::kCalibrated;  ///< As in geometry::Rig.
  double virtual_hfov = std::numeric_limits<double>::quiet_NaN();  ///< As in geometry::Rig [rad].
  /// Uses the accelerometers. The rig has their readings in either case.
  bool use_gravity = true;
};

struct Solution {
  geometry::Rig rig;  ///< Ready to be published, but for solved_at.
  Verdict verdict;
  std::optional<principal_point::Trace> trace;  ///< Of the correction, if it was done.
};

/// The data contradict one another because a corner was captured in a wrong place.
struct WrongCorner : square::SquareError {
  WrongCorner(const std::string& what, std::size_t wrong) : SquareError(what), corner(wrong) {}
  std::size_t corner;  ///< 0..3
};

/// Solves the wave of a recording, or without one its square. @throws Error as these solvers do.
square::Solution solveRecording(const wave::Recording& recording,
                                const SolveOptions& options,
                                const wave::ProgressCallback& progress = nullptr);

/// Solves samples with wave::solveWave() if they have images of a wave, else from their square with
/// the method of the options. The same samples and options give the same solution, bit for bit.
/// @throws Error as these solvers do, or: WrongCorner; neither square nor wave; what `progress`
/// throws.
Solution solveSamples(const Samples& samples,
                      const SolveOptions& options,
                      const wave::ProgressCallback& progress = nullptr);

}  // namespace wiimote_tracker::samples
