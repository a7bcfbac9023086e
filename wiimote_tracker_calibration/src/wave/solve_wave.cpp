#include "wiimote_tracker_calibration/wave/solve_wave.h"

#include "adjustment.h"
#include "checks.h"
#include "matching.h"
#include "moving_spots.h"
#include "predicted_error.h"
#include "start_path.h"
#include "start_poses.h"
#include "state.h"

#include "wave/error.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace wiimote_tracker::wave {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
// Spots are matched more and more closely. At the start lenses, clocks and poses are off [px].
constexpr double kWideGates[] = {40.0, 12.0};
constexpr double kWideLosses[] = {8.0, 3.0};
// In the end a spot is the LED's within this, and all count alike [standard deviations].
constexpr double kGate = 5.0;
constexpr int kFinalRounds = 8;
// The estimated noise has settled when a round changes it by less.
constexpr double kNoiseSettled = 0.01;
// Starts that are tried where no square gives one.
constexpr int kAttempts = 5;
// Shares of the work.
constexpr double kStartDone = 0.2;
constexpr double kPathDone = 0.35;

/// Passes progress on and stops the work when asked to.
class Reporter {
 public:
  explicit Reporter(const ProgressCallback& callback) : callback_(callback) {}

  bool keepGoing(const char* step, double fraction) {
    fraction_ = std::max(fraction_, fraction);
    return !callback_ || callback_({step, fraction_});
  }

  /// @throws Cancelled.
  void report(const char* step, double fraction) {
    if (!keepGoing(step, fraction))
      throw Cancelled("the calibration was cancelled: nothing was changed");
  }

 private:
  const ProgressCallback& callback_;
  double fraction_ = 0.0;
};

/// The recording without lamps, and with stamps from its first image on: a time since 1970 has no
/// digits left for the microseconds that an adjustment moves a clock by.
Recording prepared(const Recording& input) {
  Recording recording = input;
  double start = kInfinite;
  for (const CameraRecording& camera : input.cameras)
    start = std::min(start, camera.frames.front().stamp);
  for (CameraRecording& camera : recording.cameras) {
    camera.frames = movingSpots(camera.frames);
    for (Frame& frame : camera.frames)
      frame.stamp -= start;
  }
  return recording;
}

/// Without square the world stands upright in the first camera, if that knows where up is.
void standInFirstCamera(const Recording& recording, std::vector<geometry::Camera>* cameras) {
  const std::optional<Eigen::Vector3d>& gravity = recording.cameras.front().sightings.gravity;
  Eigen::Isometry3d world_from_first = Eigen::Isometry3d::Identity();
  if (gravity)
    world_from_first.linear() =
        Eigen::Quaterniond::FromTwoVectors(*gravity, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Isometry3d moved = world_from_first * cameras->front().world_from_camera.inverse();
  for (geometry::Camera& camera : *cameras) {
    camera.world_from_camera = moved * camera.world_from_camera;
    camera.world_from_camera.linear() =
        Eigen::Quaterniond(camera.world_from_camera.linear()).normalized().toRotationMatrix();
  }
}

bool sameSpots(const std::vector<Match>& a, const std::vector<Match>& b) {
  return a.size() == b.size() &&
         std::equal(a.begin(), a.end(), b.begin(), [](const Match& one, const Match& other) {
           return one.camera == other.camera && one.led == other.led && one.stamp == other.stamp &&
                  one.pixel == other.pixel;
         });
}

/// What the adjustment arrived at.
struct Fit {
  Matching matching;
  double pixel_stddev = 0.0;
  int iterations = 0;
};

/// Matches spots and adjusts, in turns, until neither changes.
Fit adjust(const Recording& recording,
           const WaveOptions& options,
           Adjustment* adjustment,
           State* state,
           Reporter* reporter) {
  Fit fit;
  double fraction = kPathDone;
  const auto keep_going = [&] {
    fraction += 0.05 * (1.0 - fraction);
    return reporter->keepGoing("adjusting cameras, clocks and path", fraction);
  };
  const double stamp = std::hypot(options.stamp, options.wander);
  for (std::size_t round = 0; round < std::size(kWideGates); ++round) {
    fit.matching =
        matchSpots(recording, *state, {options.pixel, stamp, kWideGates[round] / options.pixel});
    checkMatching(recording, fit.matching);
    adjustment->use(fit.matching.matches, kWideLosses[round] / options.pixel);
    fit.iterations += adjustment->solve(state, keep_going);
  }
  fit.pixel_stddev = options.pixel;
  for (int round = 0; round < kFinalRounds; ++round) {
    Matching matching = matchSpots(recording, *state, {fit.pixel_stddev, stamp, kGate});
    checkMatching(recording, matching);
    const bool same = round > 0 && sameSpots(matching.matches, fit.matching.matches);
    fit.matching = std::move(matching);
    adjustment->use(fit.matching.matches, kInfinite);
    fit.iterations += adjustment->solve(state, keep_going);
    const double misfit = adjustment->misfit(*state);
    if (same && std::abs(misfit - 1.0) < kNoiseSettled)
      break;
    fit.pixel_stddev *= misfit;
  }
  return fit;
}

/// Slow errors of the clocks hardly average out over a wave, and the offsets are means over it:
/// the variance of the mean of an error that settles with a time constant. The first camera's
/// enters all offsets.
void addWander(const WaveOptions& options, double seconds, Eigen::MatrixXd* covariance) {
  const double kSettling = 2.0;  // [s]
  const double share = std::min(1.0, 2.0 * kSettling / seconds);
  const double variance = options.wander * options.wander * share;
  for (Eigen::Index i = kCameraSize + kOffset; i < covariance->rows(); i += kCameraSize) {
    for (Eigen::Index j = kCameraSize + kOffset; j < covariance->cols(); j += kCameraSize)
      (*covariance)(i, j) += i == j ? 2.0 * variance : variance;
  }
}

/// Enough points to stand for the path.
std::vector<Eigen::Vector3d> thinned(const std::vector<Eigen::Vector3d>& path) {
  const std::size_t kEnough = 150;
  const std::size_t stride = std::max<std::size_t>(1, path.size() / kEnough);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < path.size(); i += stride)
    points.push_back(path[i]);
  return points;
}

/// From kCameraSize parameters per camera to the layout of RigCalibration.msg.
Eigen::MatrixXd inMessageOrder(const Eigen::MatrixXd& covariance, std::size_t cameras) {
  constexpr Eigen::Index kMessageSize = 16;
  const auto n = static_cast<Eigen::Index>(cameras);
  const auto place = [](Eigen::Index parameter) {
    const Eigen::Index camera = parameter / kCameraSize;
    const Eigen::Index k = parameter % kCameraSize;
    // Everything between k1 and the time offset was held.
    return kMessageSize * camera + (k == kCameraSize - 1 ? kMessageSize - 1 : k);
  };
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(kMessageSize * n, kMessageSize * n);
  for (Eigen::Index row = 0; row < covariance.rows(); ++row) {
    for (Eigen::Index column = 0; column < covariance.cols(); ++column)
      result(place(row), place(column)) = covariance(row, column);
  }
  return result;
}

geometry::RigCamera rigCamera(const CameraRecording& recording,
                              const State& state,
                              std::size_t index,
                              const Matching& matching) {
  geometry::RigCamera result;
  result.camera = state.cameras[index];
  result.time_offset = state.offsets[index];
  result.time_offset_rule = geometry::TimeOffsetRule::kOneEpoch;
  result.time_offset_epoch = recording.clock_epoch;
  result.gravity = recording.sightings.gravity;
  result.observations = static_cast<std::uint32_t>(matching.expected[index]);
  result.inliers = static_cast<std::uint32_t>(matching.found[index]);
  const geometry::Intrinsics& lens = result.camera.intrinsics;
  double squared_px = 0.0;
  double squared_m = 0.0;
  for (const Match& match : matching.matches) {
    if (match.camera != index)
      continue;
    const auto place = state.trajectory.at(match.stamp + state.offsets[index]);
    const Eigen::Vector3d point = state.trajectory.position(*place, match.led);
    const double squared = (*result.camera.project(point) - match.pixel).squaredNorm();
    squared_px += squared;
    squared_m += squared * (point - result.camera.center()).squaredNorm() / (lens.fx * lens.fy);
  }
  result.residual_px = std::sqrt(squared_px / result.inliers);
  result.residual_m = std::sqrt(squared_m / result.inliers);
  return result;
}

/// What the path was like, where it was seen.
void describePath(const State& state, const Matching& matching, WaveSolution* solution) {
  const Trajectory& trajectory = state.trajectory;
  std::vector<bool> seen(static_cast<std::size_t>(trajectory.intervals()), false);
  for (const Match& match : matching.matches)
    seen[static_cast<std::size_t>(
        trajectory.at(match.stamp + state.offsets[match.camera])->first)] = true;
  std::vector<double> speeds;
  for (Eigen::Index i = 0; i < trajectory.intervals(); ++i) {
    if (!seen[static_cast<std::size_t>(i)])
      continue;
    solution->seconds_seen += trajectory.spacing();
    const Trajectory::Place place =
        *trajectory.at(trajectory.timeOf(i) + 0.5 * trajectory.spacing());
    for (Eigen::Index led = 0; led < trajectory.leds(); ++led) {
      solution->path.push_back(trajectory.position(place, led));
      speeds.push_back(trajectory.velocity(place, led).norm());
    }
  }
  const auto middle = speeds.begin() + static_cast<std::ptrdiff_t>(speeds.size() / 2);
  std::nth_element(speeds.begin(), middle, speeds.end());
  solution->median_speed = *middle;

  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(solution->path.size()));
  for (std::size_t i = 0; i < solution->path.size(); ++i)
    points.col(static_cast<Eigen::Index>(i)) = solution->path[i];
  const Eigen::Matrix3Xd centered = points.colwise() - points.rowwise().mean();
  const Eigen::Matrix3d scatter =
      centered * centered.transpose() / static_cast<double>(points.cols());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  solution->extent = solver.eigenvalues().reverse().cwiseMax(0.0).cwiseSqrt();
}

/// From a start to a solution that passed all checks.
WaveSolution solveFrom(StartPoses poses,
                       const Recording& recording,
                       const WaveOptions& options,
                       Reporter* reporter) {
  reporter->report("following the LED", kStartDone);

  WaveSolution solution;
  solution.gauge = recording.square ? Gauge::kSquare : Gauge::kFirstCamera;
  solution.z_up = poses.z_up;
  if (!recording.square)
    standInFirstCamera(recording, &poses.cameras);
  State state;
  state.trajectory = startPath(recording, options, &poses);
  state.cameras = poses.cameras;
  state.offsets.assign(recording.cameras.size(), 0.0);
  std::vector<Eigen::Vector3d> nominal_corners;
  if (recording.square) {
    state.corners = recording.square->corners(poses.z_up);
    nominal_corners.assign(state.corners.begin(), state.corners.end());
  }
  if (recording.wand)
    state.wand_length = recording.wand->length;
  reporter->report("adjusting cameras, clocks and path", kPathDone);

  Adjustment adjustment(recording, options, nominal_corners, solution.gauge);
  const Fit fit = adjust(recording, options, &adjustment, &state, reporter);

  solution.pixel_stddev = fit.pixel_stddev;
  solution.iterations = fit.iterations;
  describePath(state, fit.matching, &solution);
  const Eigen::MatrixXd joint = adjustment.covariance(state);
  const Eigen::Index corner_column = kCameraSize * static_cast<Eigen::Index>(state.cameras.size());
  Eigen::MatrixXd covariance = joint.topLeftCorner(corner_column, corner_column);
  addWander(options, solution.seconds_seen, &covariance);
  geometry::Rig& rig = solution.rig;
  rig.method = recording.wand ? "wand" : "wave";
  rig.covariance = inMessageOrder(covariance, state.cameras.size());
  for (std::size_t i = 0; i < state.cameras.size(); ++i) {
    rig.cameras.push_back(rigCamera(recording.cameras[i], state, i, fit.matching));
    const auto stddev = [&](Eigen::Index parameter) {
      const Eigen::Index k = kCameraSize * static_cast<Eigen::Index>(i) + parameter;
      return std::sqrt(covariance(k, k));
    };
    CameraReport report;
    report.inlier_share =
        static_cast<double>(fit.matching.found[i]) / static_cast<double>(fit.matching.expected[i]);
    report.focal_stddev = stddev(6);
    report.principal_point_stddev = std::max(stddev(8), stddev(9));
    report.offset_stddev = stddev(kOffset);
    solution.cameras.push_back(report);
  }
  if (recording.square) {
    rig.method = "square+" + rig.method;
    rig.square_sides = {recording.square->side_x, recording.square->side_y};
    rig.led_height = recording.square->led_height;
    square::CornerEstimates corners;
    for (std::size_t c = 0; c < 4; ++c) {
      const Eigen::Index row = corner_column + 2 * static_cast<Eigen::Index>(c);
      solution.corner_offsets[c] = state.corners[c] - nominal_corners[c];
      corners.offsets[c] = solution.corner_offsets[c];
      corners.covariances[c] = joint.block<2, 2>(row, row);
    }
    solution.suspect = square::suspectCorner(corners, options.uncertainty.placement);
  } else {
    solution.corner_offsets.fill(Eigen::Vector3d::Zero());
  }
  solution.wand_length = state.wand_length;
  const PredictedError predicted = predictedError(rig, thinned(solution.path));
  solution.expected_error = predicted.absolute;
  solution.expected_shape_error = predicted.shape;
  checkSolution(recording, options, &solution);
  rig.verdict = verdictOf(recording, solution);
  return solution;
}

}  // namespace

WaveSolution solveWave(const Recording& input,
                       const WaveOptions& options,
                       const ProgressCallback& progress) {
  checkInput(input, options);
  Reporter reporter(progress);
  const Recording recording = prepared(input);
  std::optional<WaveError> refusal;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    reporter.report("finding where the cameras stand", 0.0);
    bool final = attempt + 1 == kAttempts;
    try {
      StartPoses poses = startPoses(recording, options, attempt);
      final = final || poses.from_square;
      WaveSolution solution = solveFrom(std::move(poses), recording, options, &reporter);
      reporter.report("done", 1.0);
      return solution;
    } catch (const Cancelled&) {
      throw;
    } catch (const WaveError& error) {
      // What the first attempt found wrong is most likely what is wrong.
      if (!refusal)
        refusal = error;
      if (final)
        throw WaveError(*refusal);
    }
  }
  throw WaveError(*refusal);
}

}  // namespace wiimote_tracker::wave
