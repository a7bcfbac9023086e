#include "wiimote_tracker_calibration/wave/solve_wave.h"

#include "adjustment.h"
#include "steps.h"

#include "capture/moving_spots.h"
#include "wave/error.h"

#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <limits>
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
// The last rounds end when one changes the estimated noise and the number of spots by less [share].
constexpr double kNoiseSettled = 0.01;
constexpr double kSpotsSettled = 0.001;
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
        geometry::so3::between(*gravity, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  moveCameras(world_from_first * cameras->front().world_from_camera.inverse(), cameras);
}

/// What the adjustment of a state left.
struct Adjusted {
  Matching matching;
  Refinement refinement{};
  double pixel_stddev;  // of a spot, estimated [px]
};

double stampStddev(const WaveOptions& options) {
  return std::hypot(options.stamp, options.wander);
}

/// Alternates matching and adjusting until neither changes noticeably.
Adjusted adjustInRounds(const Task& task, const std::function<void()>& report, State* state) {
  const WaveOptions& options = task.options;
  Adjusted result;
  // Returns the noise over that of the gate.
  const auto matchAndRefine = [&](const Gate& gate, double loss_scale) {
    result.matching = matchSpots(task.recording, *state, gate);
    checkMatching(task.recording, result.matching);
    result.refinement = refine(task, result.matching.matches, loss_scale, report, state);
    // Without redundancy it is no reason to expect less noise.
    const double ratio = result.refinement.noise_ratio;
    return result.refinement.redundancy ? ratio : std::max(1.0, ratio);
  };
  const double stamp = stampStddev(options);
  for (std::size_t round = 0; round < std::size(kWideGates); ++round)
    matchAndRefine({options.pixel, stamp, kWideGates[round] / options.pixel},
                   kWideLosses[round] / options.pixel);
  result.pixel_stddev = options.pixel;
  for (int round = 0; round < kFinalRounds; ++round) {
    const auto before = static_cast<double>(result.matching.matches.size());
    const double ratio = matchAndRefine({result.pixel_stddev, stamp, kGate}, kInfinity);
    const double change = static_cast<double>(result.matching.matches.size()) / before - 1.0;
    if (round > 0 && std::abs(change) < kSpotsSettled && std::abs(ratio - 1.0) < kNoiseSettled)
      break;
    result.pixel_stddev *= ratio;
  }
  return result;
}

/// Adjusts the state and turns it into the solution, unless clocks or noise contradict it.
square::Solution fit(const Task& task, State state, const ProgressCallback& progress) {
  const char* const kStep = "adjusting cameras, clocks and path";
  progress(kStep, kPathDone);
  double fraction = kPathDone;
  const auto report = [&] {
    fraction += 0.05 * (1.0 - fraction);
    progress(kStep, fraction);
  };
  Adjusted adjusted = adjustInRounds(task, report, &state);
  checkClocks(task, {adjusted.pixel_stddev, stampStddev(task.options), kGate}, report, state);
  checkNoise(task.options, adjusted.pixel_stddev);
  if (!task.floor.empty()) {
    useFloorAsWorld(task, &state);
    adjusted.refinement = refine(task, adjusted.matching.matches, kInfinity, report, &state);
  }
  return solutionOf(task, state, adjusted.matching, adjusted.refinement.redundancy.value_or(1.0),
                    adjusted.pixel_stddev);
}

/// From a start to a solution that passed all checks.
square::Solution solveFrom(StartPoses poses, const Task& task, const ProgressCallback& progress) {
  const Recording& recording = task.recording;
  progress("following the LED", kStartDone);
  if (!recording.square)
    useFirstCameraAsWorld(recording, &poses.cameras);
  State state;
  state.trajectory = startPath(recording, task.options, &poses.cameras);
  state.cameras = poses.cameras;
  state.offsets.assign(recording.cameras.size(), 0.0);
  state.z_up = poses.z_up;
  state.corner_offsets.fill(Eigen::Vector2d::Zero());
  if (recording.wand)
    state.wand_length = recording.wand->length;
  if (!task.floor.empty())
    checkStart(task, state);
  square::Solution solution = fit(task, std::move(state), progress);
  checkSolution(task, &solution);
  solution.rig.verdict = describe(recording, solution);
  return solution;
}

}  // namespace

square::Solution solveWave(const Recording& input,
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
      square::Solution solution = solveFrom(std::move(poses), task, report);
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
