#include "wiimote_tracker_calibration/wave/solve_wave.h"

#include "adjustment.h"
#include "checks.h"
#include "clock_step.h"
#include "matching.h"
#include "solution.h"
#include "start_path.h"
#include "start_poses.h"
#include "state.h"
#include "wand_on_floor.h"

#include "adjust/chi_squared.h"
#include "capture/moving_spots.h"
#include "wave/error.h"

#include <wiimote_tracker_msgs/text.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <numeric>
#include <utility>

namespace wiimote_tracker::wave {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Gates and scales of the robust loss of the first rounds, while lenses, clocks and poses are
// inaccurate [px].
constexpr double kWideGates[] = {40.0, 12.0};
constexpr double kWideLosses[] = {8.0, 3.0};
// Gate of the last rounds, without robust loss [standard deviations].
constexpr double kGate = 5.0;
constexpr int kFinalRounds = 8;
// The estimated noise has converged when a round changes it by less.
constexpr double kNoiseSettled = 0.01;
// Least jump of a clock [s]: more than clocks wander during a wave.
constexpr double kLeastJump = 0.004;
// Least share of the squared residuals that a jump explains, and the largest that is left without
// it.
constexpr double kLeastExplained = 0.1;
constexpr double kMostLeft = 0.9;
// Rounds in which the size of a jump is found.
constexpr int kJumpRounds = 4;
// Least factor by which a true jump grows in these rounds: by 2 where two cameras share the path,
// by 1.02 where 64 do.
constexpr double kLeastGrowth = 1.01;
// Starts that are tried where no square gives one.
constexpr int kAttempts = 5;
// Shares of the work.
constexpr double kStartDone = 0.2;
constexpr double kPathDone = 0.35;

/// The recording without lamps, and with stamps from its first image on: a time since 1970 has no
/// digits left for the microseconds that an adjustment moves a clock by.
Recording prepared(Recording recording) {
  const double start = recording.span().first;
  for (CameraRecording& camera : recording.cameras) {
    capture::removeStillSpots(&camera.frames);
    for (Frame& frame : camera.frames)
      frame.stamp -= start;
  }
  return recording;
}

/// Without square the world has its origin in the first camera, and z up by its accelerometer.
void useFirstCameraAsWorld(const Recording& recording, std::vector<geometry::Camera>* cameras) {
  const std::optional<Eigen::Vector3d>& gravity = recording.cameras.front().sightings.gravity;
  Eigen::Isometry3d world_from_first = Eigen::Isometry3d::Identity();
  if (gravity)
    world_from_first.linear() =
        Eigen::Quaterniond::FromTwoVectors(*gravity, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  moveCameras(world_from_first * cameras->front().world_from_camera.inverse(), cameras);
}

bool sameSpots(const std::vector<Match>& a, const std::vector<Match>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Match& one, const Match& other) {
                      return one.camera == other.camera && one.led == other.led &&
                             one.stamp == other.stamp && one.pixel == other.pixel;
                    });
}

bool contradicts(const Agreement& agreement) {
  return agreement.chi_squared >
         adjust::chiSquaredQuantile(std::max(1.0, agreement.degrees_of_freedom),
                                    adjust::kThreeNines);
}

struct ClockJump {
  std::size_t camera;  // Index in the recording.
  double size;         // [s]
};

/// The jump of a clock without which everything fits better. The path follows a clock that jumps
/// and hides a part of the jump. So the largest step is removed, the path is fitted again, and the
/// step is measured again: a true one grows.
std::optional<ClockJump> findJump(const Task& task,
                                  const Gate& gate,
                                  const std::function<void()>& report,
                                  State state) {
  // Images before or after a jump may be far off.
  Gate wide = gate;
  wide.limit = kWideGates[0] / gate.pixel_stddev;
  const auto stepsOf = [&](const Recording& waved) {
    return clockSteps(state, matchSpots(waved, state, wide).matches);
  };
  const auto squared = [](const std::vector<ClockStep>& steps) {
    return std::accumulate(steps.begin(), steps.end(), 0.0,
                           [](double sum, const ClockStep& step) { return sum + step.squared; });
  };
  std::vector<ClockStep> steps = stepsOf(task.recording);
  const double before = squared(steps);
  const auto worst = std::max_element(
      steps.begin(), steps.end(),
      [](const ClockStep& a, const ClockStep& b) { return a.explained < b.explained; });
  const auto camera = static_cast<std::size_t>(worst - steps.begin());
  const double apparent = std::abs(worst->size);
  if (worst->explained < kLeastExplained * before || apparent < kLeastJump)
    return std::nullopt;
  Task corrected = task;
  Matching matching;
  for (int round = 0; round < kJumpRounds; ++round) {
    corrected.recording = task.recording;
    for (Frame& frame : corrected.recording.cameras[camera].frames)
      frame.stamp -= frame.stamp > steps[camera].after ? steps[camera].size : 0.0;
    matching = matchSpots(corrected.recording, state, gate);
    if (std::count(matching.found.begin(), matching.found.end(), 0) > 0)
      return std::nullopt;  // not a step: the camera would fit nowhere
    refine(corrected, matching.matches, kInfinity, report, &state);
    steps = stepsOf(task.recording);
  }
  if (std::abs(steps[camera].size) < kLeastGrowth * apparent ||
      squared(stepsOf(corrected.recording)) > kMostLeft * before ||
      contradicts(agreementOf(corrected, matching.matches, state)))
    return std::nullopt;
  return ClockJump{camera, steps[camera].size};
}

[[noreturn]] void refuse(const ClockJump& jump, const Recording& recording) {
  // Of two cameras either clock may have jumped.
  const bool two = recording.cameras.size() == 2;
  const auto name = [&](std::size_t camera) { return recording.cameras[camera].sightings.name; };
  throw WaveError("the clock of " + (two ? name(0) + " or " + name(1) : name(jump.camera)) +
                  format(" jumped by about %.0f ms during the wave: check the time of its computer "
                         "and its driver, and wave again",
                         1e3 * std::abs(jump.size)));
}

WaveSolution summarise(const Task& task,
                       const State& state,
                       const Matching& matching,
                       const Refinement& refinement,
                       double pixel_stddev) {
  WaveSolution solution = solutionOf(task, state, matching);
  solution.pixel_stddev = pixel_stddev;
  // The fit follows the noise in part: divided by the redundancy, the residuals tell all of it.
  for (geometry::RigCamera& camera : solution.rig.cameras) {
    camera.residual_px /= std::sqrt(refinement.redundancy.value_or(1.0));
    camera.residual_m /= std::sqrt(refinement.redundancy.value_or(1.0));
  }
  const Agreement agreement = agreementOf(task, matching.matches, state);
  solution.misfit = std::sqrt(agreement.chi_squared / std::max(1.0, agreement.degrees_of_freedom));
  solution.contradicts = contradicts(agreement);
  return solution;
}

/// Alternates matching and adjusting until neither changes.
WaveSolution fit(const Task& task, State state, const ProgressCallback& progress) {
  const WaveOptions& options = task.options;
  const char* const kStep = "adjusting cameras, clocks and path";
  progress(kStep, kPathDone);
  double fraction = kPathDone;
  const auto report = [&] {
    fraction += 0.05 * (1.0 - fraction);
    progress(kStep, fraction);
  };
  Matching matching;
  Refinement refinement{};
  // Returns the noise over that of the gate.
  const auto matchAndRefine = [&](const Gate& gate, double loss_scale) {
    matching = matchSpots(task.recording, state, gate);
    checkMatching(task.recording, matching);
    refinement = refine(task, matching.matches, loss_scale, report, &state);
    // Without redundancy it is no reason to expect less noise.
    return refinement.redundancy ? refinement.noise_ratio : std::max(1.0, refinement.noise_ratio);
  };
  const double stamp = std::hypot(options.stamp, options.wander);
  for (std::size_t round = 0; round < std::size(kWideGates); ++round)
    matchAndRefine({options.pixel, stamp, kWideGates[round] / options.pixel},
                   kWideLosses[round] / options.pixel);
  double pixel_stddev = options.pixel;
  for (int round = 0; round < kFinalRounds; ++round) {
    const std::vector<Match> before = std::move(matching.matches);
    const double ratio = matchAndRefine({pixel_stddev, stamp, kGate}, kInfinity);
    if (round > 0 && sameSpots(matching.matches, before) && std::abs(ratio - 1.0) < kNoiseSettled)
      break;
    pixel_stddev *= ratio;
  }
  if (const auto jump = findJump(task, {pixel_stddev, stamp, kGate}, report, state))
    refuse(*jump, task.recording);
  checkNoise(options, pixel_stddev);
  if (!task.floor.empty()) {
    useFloorAsWorld(task, &state);
    refinement = refine(task, matching.matches, kInfinity, report, &state);
  }
  return summarise(task, state, matching, refinement, pixel_stddev);
}

/// From a start to a solution that passed all checks.
WaveSolution solveFrom(StartPoses poses, const Task& task, const ProgressCallback& progress) {
  const Recording& recording = task.recording;
  progress("following the LED", kStartDone);
  if (!recording.square)
    useFirstCameraAsWorld(recording, &poses.cameras);
  State state;
  state.trajectory = startPath(recording, task.options, &poses);
  state.cameras = poses.cameras;
  state.offsets.assign(recording.cameras.size(), 0.0);
  state.z_up = poses.z_up;
  state.corner_offsets.fill(Eigen::Vector2d::Zero());
  if (recording.wand)
    state.wand_length = recording.wand->length;
  if (!task.floor.empty())
    checkStart(task, state);
  WaveSolution solution = fit(task, std::move(state), progress);
  checkSolution(task, &solution);
  solution.rig.verdict = verdictOf(recording, solution);
  return solution;
}

}  // namespace

WaveSolution solveWave(const Recording& input,
                       const WaveOptions& options,
                       const ProgressCallback& progress) {
  // Another start begins again, but what is reported only grows.
  const ProgressCallback report = [&, most = 0.0](const std::string& step,
                                                  double fraction) mutable {
    most = std::max(most, fraction);
    if (progress)
      progress(step, most);
  };
  Recording waved = input;
  FloorSpots floor = takeFloor(&waved);
  checkInput(waved);
  const Task task = {prepared(std::move(waved)), options, std::move(floor)};
  std::exception_ptr refusal;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    report("finding where the cameras stand", 0.0);
    bool is_only_start = false;
    try {
      StartPoses poses = startPoses(task.recording, options, attempt);
      is_only_start = poses.from_square;
      WaveSolution solution = solveFrom(std::move(poses), task, report);
      report("done", 1.0);
      return solution;
    } catch (const WandMislaid&) {
      throw;
    } catch (const WaveError&) {
      // The refusal of the first attempt names the most likely cause.
      if (!refusal)
        refusal = std::current_exception();
      if (is_only_start)
        break;
    }
  }
  std::rethrow_exception(refusal);
}

}  // namespace wiimote_tracker::wave
