#include "samples/solve_samples.h"

#include "diagnose.h"
#include "judge.h"
#include "square/error.h"
#include "wave/error.h"

#include <wiimote_tracker_msgs/error.h>

#include <algorithm>
#include <utility>

namespace wiimote_tracker::samples {

namespace {

/// Corrects the principal points of a solved square. The suspect corner stays that of the first
/// solution: the correction moves the error of a corner into the lenses.
void correctPrincipalPoints(const wave::Recording& recording,
                            const SolveOptions& options,
                            const wave::ProgressCallback& progress,
                            square::Solution* found,
                            std::optional<principal_point::Trace>* trace) {
  const principal_point::CorrectionOptions correction = {
      options.correction, options.ray_model, options.virtual_hfov, options.square.uncertainty,
      options.square.branch_odds};
  const principal_point::CorrectionResult result = principal_point::correctPrincipalPoints(
      *recording.square, recording.sightings(), correction, [&](int rounds) {
        if (progress)
          progress("correcting the principal points",
                   static_cast<double>(rounds) / std::max(1, correction.rounds));
      });
  found->rig = result.rig;
  found->joint_covariance.resize(0, 0);
  found->z_up = result.z_up;
  found->warnings = result.warnings;
  *trace = result.trace;
}

/// As solveRecording(), with corrected principal points if the options ask for it.
square::Solution solve(const wave::Recording& recording,
                       const SolveOptions& options,
                       const wave::ProgressCallback& progress,
                       std::optional<principal_point::Trace>* trace) {
  if (recording.hasFrames()) {
    square::Solution found = solveRecording(recording, options, progress);
    if (options.correct_principal_points)
      found.rig.verdict +=
          "; the principal points were not corrected, because the wave determines them itself";
    return found;
  }
  if (progress)
    progress("solving the square", 0.0);
  const bool exact =
      options.square.method == square::Method::kPerCamera || options.correct_principal_points;
  if (exact && !(recording.square->lengths.empty() && recording.square->places.empty()))
    throw square::SquareError(
        "lengths and known places need the method joint without principal_point_correction: record "
        "a wave, or drop the lengths and places");
  square::Solution found = solveRecording(recording, options);
  if (options.correct_principal_points)
    correctPrincipalPoints(recording, options, progress, &found, trace);
  return found;
}

/// The same; names the mistake where the data contradict one another.
square::Solution solveOrDiagnose(const wave::Recording& recording,
                                 const SolveOptions& options,
                                 const wave::ProgressCallback& progress,
                                 std::optional<principal_point::Trace>* trace) {
  const auto words = [&](const geometry::Error& error, bool contradicts) {
    const auto mistake = diagnose(recording, options, contradicts, progress);
    if (mistake && mistake->corner)
      throw WrongCorner(mistake->text, *mistake->corner);
    return mistake ? mistake->text : error.what();
  };
  try {
    square::Solution found = solve(recording, options, progress, trace);
    if (!found.contradicts)
      return found;
    if (const auto mistake = diagnose(recording, options, true, progress)) {
      found.warnings.push_back("most likely " + mistake->text);
      if (!mistake->corner)
        found.suspect.reset();
    }
    return found;
  } catch (const square::SquareContradiction& error) {
    throw square::SquareError(words(error, true));
  } catch (const wave::WaveError& error) {
    throw wave::WaveError(
        words(error, dynamic_cast<const wave::WaveContradiction*>(&error) != nullptr));
  }
}

}  // namespace

square::Solution solveRecording(const wave::Recording& recording,
                                const SolveOptions& options,
                                const wave::ProgressCallback& progress) {
  if (recording.hasFrames())
    return wave::solveWave(recording, {options.wave, options.square.uncertainty}, progress);
  return square::solveSquare(*recording.square, recording.sightings(), options.square);
}

Solution solveSamples(const Samples& samples,
                      const SolveOptions& options,
                      const wave::ProgressCallback& progress) {
  wave::Recording recording = samples.recording;
  for (wave::CameraRecording& camera : recording.cameras) {
    if (!options.use_gravity)
      camera.sightings.gravity.reset();
  }
  if (!recording.hasFrames() && !recording.square)
    throw Error(
        "nothing was captured: capture the corners of a square, or wave a wand of known length");
  Solution solution;
  square::Solution found = solveOrDiagnose(recording, options, progress, &solution.trace);

  geometry::Rig& rig = found.rig;
  rig.world_frame = samples.world_frame;
  rig.ray_model = options.ray_model;
  rig.virtual_hfov = options.virtual_hfov;
  for (const wave::CameraRecording& captured : samples.recording.cameras) {
    for (geometry::RigCamera& camera : rig.cameras) {
      if (camera.camera.name != captured.sightings.name)
        continue;
      camera.masks = captured.masks;
      camera.gravity = captured.sightings.gravity;
    }
  }
  solution.verdict = judge(samples, found, options.square.uncertainty.pixel);
  rig.verdict = solution.verdict.text;
  rig.check();
  solution.rig = std::move(rig);
  return solution;
}

}  // namespace wiimote_tracker::samples
