#pragma once

#include "session.h"

#include "wiimote_tracker_calibration/principal_point/correction.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <optional>

// Calibrations of a session by the paper's methods and ours, and points measured with them.
namespace wiimote_tracker::monte_carlo {

/// The paper's five (section V.B).
enum class PaperCase {
  kC1,  ///< K (2).
  kC2,  ///< K from 12 views of the board.
  kC3,  ///< C1, principal points corrected in 14 rounds.
  kC4,  ///< C2, corrected.
  kC5,  ///< Focal lengths of C2, principal points (512, 384), corrected.
};

/// @throws geometry::Error if the session cannot be solved.
principal_point::CorrectionResult solvePaperCase(const PaperSession& session,
                                                 PaperCase which,
                                                 geometry::RayModel ray_model);

/// The square alone, in one adjustment. @throws geometry::Error.
geometry::Rig solveJointSquare(const PaperSession& session);

/// The square and a wave of an LED or a wand. @throws geometry::Error.
geometry::Rig solveWaved(const wave::SimulatedWave& wave);

/// Position of a still LED, measured by a rig of the session. Nothing if it cannot be triangulated.
std::optional<geometry::TriangulatedPoint> measure(const PaperSession& session,
                                                   const geometry::Rig& rig,
                                                   const StillLed& led,
                                                   const geometry::TriangulationOptions& options);

}  // namespace wiimote_tracker::monte_carlo
