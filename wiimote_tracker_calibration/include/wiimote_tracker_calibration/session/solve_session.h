#ifndef WIIMOTE_TRACKER_CALIBRATION_SESSION_SOLVE_SESSION_H
#define WIIMOTE_TRACKER_CALIBRATION_SESSION_SOLVE_SESSION_H

#include "wiimote_tracker_calibration/principal_point/correction.h"
#include "wiimote_tracker_calibration/session/session.h"
#include "wiimote_tracker_calibration/session/verdict.h"
#include "wiimote_tracker_calibration/square/solve_square.h"
#include "wiimote_tracker_calibration/wave/solve_wave.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <limits>
#include <optional>

namespace wiimote_tracker::session {

struct SolveOptions {
  /// Its uncertainty holds for the wave and the correction, too.
  square::SolveOptions square;
  /// Its uncertainty is not read.
  wave::WaveOptions wave;
  /// Corrects the principal points as the paper does (section IV.C). Of a square alone only: a wave
  /// determines them itself.
  bool correct_principal_points = false;
  /// Its ray model, uncertainty and branch odds are not read.
  principal_point::CorrectionOptions correction;
  geometry::RayModel ray_model = geometry::RayModel::kCalibrated;  ///< As in geometry::Rig.
  double virtual_hfov = std::numeric_limits<double>::quiet_NaN();  ///< As in geometry::Rig [rad].
  /// Weighs the accelerometers in. The rig bears their readings in either case.
  bool use_gravity = true;
};

struct Solution {
  geometry::Rig rig;  ///< Ready to be published, but for solved_at.
  Verdict verdict;
  std::optional<principal_point::Trace> trace;  ///< Of the correction, if there was one.
};

/// Cameras from all that was captured: with frames of a wave or a wand by wave::solveWave(), else
/// from the square alone, by the method of the options. The same session and options give the same
/// solution, bit for bit.
/// @throws square::SquareError, wave::WaveError, principal_point::CorrectionError as these solvers
/// do; SessionError: neither square nor wave. wave::Cancelled: `progress` asked to stop.
Solution solveSession(const Session& session,
                      const SolveOptions& options,
                      const wave::ProgressCallback& progress = nullptr);

}  // namespace wiimote_tracker::session

#endif  // WIIMOTE_TRACKER_CALIBRATION_SESSION_SOLVE_SESSION_H
