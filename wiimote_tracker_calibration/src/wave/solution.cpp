#include "steps.h"

#include "adjustment.h"

#include "adjust/stamp_error.h"
#include "square/expected_error.h"

#include <wiimote_tracker_msgs/median.h>
#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace wiimote_tracker::wave {

namespace {

/// Adds the slow errors of the clocks, which hardly average out over a wave, to the offsets. The
/// first camera's error enters all offsets.
void addWander(const WaveOptions& options, double seconds, Eigen::MatrixXd* covariance) {
  const double variance = adjust::meanStampVariance(options.wander, seconds);
  constexpr Eigen::Index kStep = geometry::kParameters;
  constexpr Eigen::Index kSecond = kStep + geometry::kTimeOffset;
  for (Eigen::Index i = kSecond; i < covariance->rows(); i += kStep) {
    for (Eigen::Index j = kSecond; j < covariance->cols(); j += kStep)
      (*covariance)(i, j) += i == j ? 2.0 * variance : variance;
  }
}

/// A sample of the path's points.
std::vector<Eigen::Vector3d> thinned(const std::vector<Eigen::Vector3d>& path) {
  const std::size_t kEnough = 150;
  const std::size_t stride = std::max<std::size_t>(1, path.size() / kEnough);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < path.size(); i += stride)
    points.push_back(path[i]);
  return points;
}

geometry::RigCamera rigCamera(const CameraRecording& recording,
                              const State& state,
                              std::size_t index,
                              const Matching& matching,
                              double redundancy) {
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
  double count = 0.0;
  for (const Match& match : matching.matches) {
    if (match.camera != index)
      continue;
    const Trajectory::Place place =
        state.trajectory.in(match.interval, match.stamp + result.time_offset);
    const Eigen::Vector3d point = state.trajectory.position(place, match.led);
    const auto pixel = result.camera.project(point);
    // The adjustment may move a point beyond the fold of the lens, where it has no pixel.
    if (!pixel)
      continue;
    const double squared = (*pixel - match.pixel).squaredNorm();
    squared_px += squared;
    squared_m += squared * (point - result.camera.center()).squaredNorm() / (lens.fx * lens.fy);
    count += 1.0;
  }
  // The fit follows the noise in part: divided by the redundancy, the residuals tell all of it.
  result.residual_px = std::sqrt(squared_px / (redundancy * count));
  result.residual_m = std::sqrt(squared_m / (redundancy * count));
  return result;
}

/// Duration, speeds and extent of the path where it was seen.
void describePath(const State& state, const Matching& matching, square::Solution* solution) {
  const Trajectory& trajectory = state.trajectory;
  std::vector<double> speeds;
  for (const Eigen::Index i : seenIntervals(matching.matches)) {
    solution->wave->seconds_seen += trajectory.spacing();
    const Trajectory::Place place =
        trajectory.in(i, trajectory.timeOf(i) + 0.5 * trajectory.spacing());
    for (Eigen::Index led = 0; led < trajectory.leds(); ++led) {
      solution->path.push_back(trajectory.position(place, led));
      speeds.push_back(trajectory.velocity(place, led).norm());
    }
  }
  solution->wave->median_speed = medianOf(&speeds);
  solution->wave->extent = geometry::spreadOf(solution->path);
}

}  // namespace

square::Solution solutionOf(const Task& task,
                            const State& state,
                            const Matching& matching,
                            double redundancy,
                            double pixel_stddev) {
  const Recording& recording = task.recording;
  square::Solution solution;
  square::WavePart& wave = solution.wave.emplace();
  wave.pixel_stddev = pixel_stddev;
  wave.wand_length = state.wand_length;
  solution.z_up = state.z_up;
  describePath(state, matching, &solution);

  solution.joint_covariance = covarianceOf(task, matching.matches, state);
  const Eigen::Index cameras = geometry::firstParameter(state.cameras.size());
  geometry::Rig& rig = solution.rig;
  rig.method = recording.wand ? "wand" : "wave";
  rig.covariance = solution.joint_covariance.topLeftCorner(cameras, cameras);
  addWander(task.options, wave.seconds_seen, &rig.covariance);
  for (std::size_t i = 0; i < state.cameras.size(); ++i)
    rig.cameras.push_back(rigCamera(recording.cameras[i], state, i, matching, redundancy));
  if (state.floor) {
    rig.method = "floor+wand";
    rig.led_height = *recording.wand->led_height;
  }
  if (recording.square) {
    rig.method = "square+" + rig.method;
    recording.square->describeIn(&rig);
    for (std::size_t c = 0; c < state.corner_offsets.size(); ++c)
      solution.corner_offsets[c].head<2>() = state.corner_offsets[c];
    solution.suspect = square::suspectCorner(solution.corner_offsets, solution.joint_covariance,
                                             task.options.uncertainty.placement);
  }
  const std::vector<Eigen::Vector3d> points = thinned(solution.path);
  solution.expected_error = square::expectedError(rig, points);
  wave.expected_shape_error = square::expectedShapeError(rig, points);
  const Agreement agreement = agreementOf(task, matching.matches, state);
  solution.misfit = std::sqrt(agreement.chi_squared / std::max(1.0, agreement.degrees_of_freedom));
  solution.contradicts = agreement.isContradiction();
  return solution;
}

}  // namespace wiimote_tracker::wave
