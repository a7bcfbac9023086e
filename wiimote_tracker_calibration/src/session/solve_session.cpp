#include "wiimote_tracker_calibration/session/solve_session.h"

#include "judge.h"
#include "wiimote_tracker_calibration/session/error.h"
#include "wiimote_tracker_calibration/wave/error.h"

#include <algorithm>
#include <utility>

namespace wiimote_tracker::session {

namespace {

constexpr const char* kCancelled = "the calibration was cancelled: nothing was changed";

/// A rig and what else its solver found out.
struct Solved {
  geometry::Rig rig;
  Findings findings;
  std::optional<principal_point::Trace> trace;
};

bool hasFrames(const wave::Recording& recording) {
  return std::any_of(recording.cameras.begin(), recording.cameras.end(),
                     [](const wave::CameraRecording& camera) { return !camera.frames.empty(); });
}

Solved solveFromWave(const wave::Recording& recording,
                     const SolveOptions& options,
                     const wave::ProgressCallback& progress) {
  wave::WaveOptions wave_options = options.wave;
  wave_options.uncertainty = options.square.uncertainty;
  wave::WaveSolution solution = wave::solveWave(recording, wave_options, progress);
  Solved solved;
  solved.rig = std::move(solution.rig);
  solved.findings.z_up = solution.z_up;
  solved.findings.suspect = solution.suspect;
  solved.findings.doubts = !solution.warnings.empty();
  if (solution.gauge == wave::Gauge::kFirstCamera)
    solved.findings.shape_error = solution.expected_shape_error;
  if (options.correct_principal_points)
    solved.rig.verdict +=
        "; the principal points were not corrected, because the wave determines them itself";
  return solved;
}

/// A warning about the direction of z, of which the solvers tell once, is none about the quality.
bool tellOfDoubts(const std::vector<std::string>& warnings, bool z_up) {
  return warnings.size() > (z_up ? 0U : 1U);
}

Solved solveFromSquare(const square::SquareLayout& layout,
                       const std::vector<square::CameraSightings>& cameras,
                       const SolveOptions& options) {
  const square::SquareSolution solution = square::solveSquare(layout, cameras, options.square);
  Solved solved;
  solved.rig = solution.rig;
  solved.findings.z_up = solution.z_up;
  solved.findings.suspect = solution.suspect;
  solved.findings.doubts = tellOfDoubts(solution.warnings, solution.z_up);
  return solved;
}

Solved solveCorrected(const square::SquareLayout& layout,
                      const std::vector<square::CameraSightings>& cameras,
                      const SolveOptions& options,
                      const wave::ProgressCallback& progress) {
  principal_point::CorrectionOptions correction = options.correction;
  correction.ray_model = options.ray_model;
  correction.virtual_hfov = options.virtual_hfov;
  correction.uncertainty = options.square.uncertainty;
  correction.branch_odds = options.square.branch_odds;
  const auto report = [&](int rounds, const principal_point::Trace&) {
    return !progress || progress({"correcting the principal points",
                                  static_cast<double>(rounds) / std::max(1, correction.rounds)});
  };
  // The corners are judged at the start: a correction hides in the lenses what a corner does.
  const square::SquareSolution before = square::solveSquare(layout, cameras, options.square);
  const principal_point::CorrectionResult result =
      principal_point::correctPrincipalPoints(layout, cameras, correction, report);
  if (result.outcome == principal_point::Outcome::kCancelled)
    throw wave::Cancelled(kCancelled);
  Solved solved;
  solved.rig = result.rig;
  solved.findings.z_up = result.z_up;
  solved.findings.suspect = before.suspect;
  solved.findings.doubts = tellOfDoubts(result.warnings, result.z_up);
  solved.trace = result.trace;
  return solved;
}

Solved solveAny(const wave::Recording& recording,
                const SolveOptions& options,
                const wave::ProgressCallback& progress) {
  if (hasFrames(recording))
    return solveFromWave(recording, options, progress);
  if (!recording.square)
    throw SessionError(
        "nothing was captured: capture the corners of a square, or wave a wand of known length");
  std::vector<square::CameraSightings> cameras;
  for (const wave::CameraRecording& camera : recording.cameras)
    cameras.push_back(camera.sightings);
  if (progress && !progress({"solving the square", 0.0}))
    throw wave::Cancelled(kCancelled);
  return options.correct_principal_points
             ? solveCorrected(*recording.square, cameras, options, progress)
             : solveFromSquare(*recording.square, cameras, options);
}

}  // namespace

Solution solveSession(const Session& session,
                      const SolveOptions& options,
                      const wave::ProgressCallback& progress) {
  if (session.masks.size() != session.recording.cameras.size())
    throw SessionError("the masks are not of as many cameras as were captured: capture again");
  wave::Recording recording = session.recording;
  for (wave::CameraRecording& camera : recording.cameras) {
    if (!options.use_gravity)
      camera.sightings.gravity.reset();
  }
  Solved solved = solveAny(recording, options, progress);

  geometry::Rig& rig = solved.rig;
  rig.world_frame = session.world_frame;
  rig.ray_model = options.ray_model;
  rig.virtual_hfov = options.virtual_hfov;
  for (geometry::RigCamera& camera : rig.cameras) {
    for (std::size_t i = 0; i < recording.cameras.size(); ++i) {
      const square::CameraSightings& sightings = session.recording.cameras[i].sightings;
      if (sightings.name != camera.camera.name)
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
