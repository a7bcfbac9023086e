#include "session/solve_session.h"

#include "diagnose.h"
#include "judge.h"
#include "square/error.h"
#include "wave/error.h"

#include <wiimote_tracker_msgs/error.h>

#include <algorithm>
#include <utility>

namespace wiimote_tracker::session {

namespace {

/// A rig and the other results of its solver.
struct Solved {
  geometry::Rig rig;
  Findings findings;
  std::optional<principal_point::Trace> trace;
};

/// Whether a warning concerns the quality. The one that z points down does not.
bool hasDoubts(const std::vector<std::string>& warnings, bool z_up) {
  return warnings.size() > (z_up ? 0U : 1U);
}

Solved solvedBy(const square::Solution& solution, const SolveOptions& options) {
  Solved solved;
  solved.rig = solution.rig;
  solved.findings.z_up = solution.z_up;
  solved.findings.suspect = solution.suspect;
  solved.findings.doubts = hasDoubts(solution.warnings, solution.z_up);
  solved.findings.contradicts = solution.contradicts;
  solved.findings.joint = {solution.joint_covariance, options.square.uncertainty.pixel};
  return solved;
}

Solved solveFromWave(const wave::Recording& recording,
                     const SolveOptions& options,
                     const wave::ProgressCallback& progress) {
  wave::WaveOptions wave_options = options.wave;
  wave_options.uncertainty = options.square.uncertainty;
  wave::WaveSolution solution = wave::solveWave(recording, wave_options, progress);
  Solved solved = solvedBy(solution, options);
  solved.findings.led = std::move(solution.path);
  if (!recording.square)
    solved.findings.shape_error = solution.expected_shape_error;
  if (options.correct_principal_points)
    solved.rig.verdict +=
        "; the principal points were not corrected, because the wave determines them itself";
  return solved;
}

/// Solves the square, with corrected principal points if the options ask for it.
Solved solveFromSquare(const square::SquareLayout& layout,
                       const std::vector<square::CameraSightings>& cameras,
                       const SolveOptions& options,
                       const wave::ProgressCallback& progress) {
  if (progress && !progress({"solving the square", 0.0}))
    throw wave::Cancelled();
  const bool exact =
      options.square.method == square::Method::kPerCamera || options.correct_principal_points;
  if (exact && !(layout.lengths.empty() && layout.places.empty()))
    throw square::SquareError(
        "lengths and known places need the method joint without principal_point_correction: set "
        "these, record a wave, or drop the lengths and places");
  const square::SquareSolution solution = square::solveSquare(layout, cameras, options.square);
  Solved solved = solvedBy(solution, options);
  const square::Corners corners = layout.corners(solution.z_up);
  solved.findings.led.assign(corners.begin(), corners.end());
  if (!options.correct_principal_points)
    return solved;
  // The suspect corner stays that of the first solution: the correction moves the error of a corner
  // into the lenses.
  principal_point::CorrectionOptions correction = options.correction;
  correction.ray_model = options.ray_model;
  correction.virtual_hfov = options.virtual_hfov;
  correction.uncertainty = options.square.uncertainty;
  correction.branch_odds = options.square.branch_odds;
  const principal_point::CorrectionResult result = principal_point::correctPrincipalPoints(
      layout, cameras, correction, [&](int rounds, const principal_point::Trace&) {
        return !progress ||
               progress({"correcting the principal points",
                         static_cast<double>(rounds) / std::max(1, correction.rounds)});
      });
  if (result.outcome == principal_point::Outcome::kCancelled)
    throw wave::Cancelled();
  solved.rig = result.rig;
  solved.findings.joint = {};
  solved.findings.z_up = result.z_up;
  solved.findings.doubts = hasDoubts(result.warnings, result.z_up);
  solved.trace = result.trace;
  return solved;
}

Solved solve(const wave::Recording& recording,
             const SolveOptions& options,
             const wave::ProgressCallback& progress) {
  return recording.hasFrames()
             ? solveFromWave(recording, options, progress)
             : solveFromSquare(*recording.square, recording.sightings(), options, progress);
}

/// The same; names the mistake where the data contradict one another.
Solved solveOrDiagnose(const wave::Recording& recording,
                       const SolveOptions& options,
                       const wave::ProgressCallback& progress) {
  const auto words = [&](const geometry::Error& error, bool contradicts) {
    const auto mistake = diagnose(recording, options, contradicts, progress);
    return mistake ? mistake->text : error.what();
  };
  try {
    Solved solved = solve(recording, options, progress);
    if (!solved.findings.contradicts)
      return solved;
    if (const auto mistake = diagnose(recording, options, true, progress)) {
      solved.rig.verdict += "; warning: most likely " + mistake->text;
      solved.findings.doubts = true;
      if (!mistake->corner)
        solved.findings.suspect.reset();
    }
    return solved;
  } catch (const wave::Cancelled&) {
    throw;
  } catch (const square::SquareContradiction& error) {
    throw square::SquareError(words(error, true));
  } catch (const wave::WaveError& error) {
    throw wave::WaveError(
        words(error, dynamic_cast<const wave::WaveContradiction*>(&error) != nullptr));
  }
}

}  // namespace

Solution solveSession(const Session& session,
                      const SolveOptions& options,
                      const wave::ProgressCallback& progress) {
  if (session.masks.size() != session.recording.cameras.size())
    throw Error("the session has masks for another number of cameras: capture again");
  wave::Recording recording = session.recording;
  for (wave::CameraRecording& camera : recording.cameras) {
    if (!options.use_gravity)
      camera.sightings.gravity.reset();
  }
  if (!recording.hasFrames() && !recording.square)
    throw Error(
        "nothing was captured: capture the corners of a square, or wave a wand of known length");
  Solved solved = solveOrDiagnose(recording, options, progress);

  geometry::Rig& rig = solved.rig;
  rig.world_frame = session.world_frame;
  rig.ray_model = options.ray_model;
  rig.virtual_hfov = options.virtual_hfov;
  for (std::size_t i = 0; i < recording.cameras.size(); ++i) {
    const square::CameraSightings& sightings = session.recording.cameras[i].sightings;
    for (geometry::RigCamera& camera : rig.cameras) {
      if (camera.camera.name != sightings.name)
        continue;
      camera.masks = session.masks[i];
      camera.gravity = sightings.gravity;
    }
  }
  Solution solution;
  solution.verdict = judge(session, rig, solved.findings);
  rig.verdict = solution.verdict.text;
  rig.check();
  solution.rig = std::move(rig);
  solution.trace = std::move(solved.trace);
  return solution;
}

}  // namespace wiimote_tracker::session
