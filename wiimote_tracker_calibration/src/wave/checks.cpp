#include "steps.h"

#include "capture/moving_spots.h"
#include "square/lens_priors.h"
#include "square/limits.h"
#include "square/usable_cameras.h"
#include "wave/error.h"

#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::wave {

namespace {

using capture::kLeastSightings;
using capture::kThinnestPath;

// Longer recordings are not better, and probably contain a jump of a clock [s].
constexpr double kLongest = 900.0;
constexpr double kShortest = 2.0;
// Deviations from stated values that are reported, and refused [standard deviations].
constexpr double kWarnDeviation = 4.0;
constexpr double kRefuseDeviation = 10.0;

bool isOnFloor(const Recording& recording) {
  return recording.wand && recording.wand->led_height;
}

void checkSightings(const CameraRecording& camera, bool wand) {
  const auto usable = static_cast<std::size_t>(
      std::count_if(camera.frames.begin(), camera.frames.end(),
                    [&](const Frame& frame) { return frame.spots.size() >= (wand ? 2U : 1U); }));
  if (usable < kLeastSightings)
    throw WaveError(camera.sightings.name + " saw " + (wand ? "both LEDs of the wand" : "the LED") +
                    " in " + std::to_string(usable) + " images only, but needs " +
                    std::to_string(kLeastSightings) +
                    ": wave longer where it sees it, or leave this camera out");
}

}  // namespace

void Wand::check() const {
  const auto refuse = [](const char* name, double value, const std::string& range) {
    throw WaveError(
        format("%s is %g m, but must be %s: measure between the middles of the wand's "
               "LEDs, in metres",
               name, value, range.c_str()));
  };
  if (!(length > 0.0 && length <= kMaximumLength))
    refuse("wand_length", length, format("above 0 and at most %g", kMaximumLength));
  if (!(stddev > 0.0) || !std::isfinite(stddev))
    refuse("wand_stddev", stddev, "above 0");
  if (led_height && (!(*led_height >= 0.0) || !std::isfinite(*led_height)))
    refuse("led_height", *led_height, "0 or above");
}

void checkInput(const Recording& recording) {
  if (recording.cameras.size() < 2)
    throw WaveError("one camera alone does not determine depth: use two or more");
  if (!recording.square && !recording.wand)
    throw WaveError(
        "the scale is not determined: capture the corners of a square, or wave a wand of "
        "known length");
  if (recording.square && isOnFloor(recording))
    throw WaveError(
        "the square and the wand on the floor give one world each: drop the corners, or wave the "
        "wand without laying it on the floor");
  if (recording.square)
    recording.square->check();
  if (recording.wand)
    recording.wand->check();
  for (const CameraRecording& camera : recording.cameras) {
    try {
      camera.sightings.intrinsics.check();
    } catch (const geometry::Error& error) {
      throw WaveError(camera.sightings.name + ": " + error.what());
    }
    checkSightings(camera, recording.wand.has_value());
  }
  const auto [start, end] = recording.span();
  if (end - start > kLongest)
    throw WaveError(
        format("the images are of times %.0f s apart: check that all cameras use the same clock, "
               "and wave for less than %.0f s",
               end - start, kLongest));
  if (end - start < kShortest)
    throw WaveError(format("the recording is %.1f s long: wave for 15 s or more", end - start));
}

void checkMatching(const Recording& recording, const Matching& matching) {
  for (std::size_t i = 0; i < recording.cameras.size(); ++i) {
    const std::string& name = recording.cameras[i].sightings.name;
    const std::size_t found = matching.found[i];
    const std::size_t expected = matching.expected[i];
    if (static_cast<double>(found) < capture::kLeastFitting * static_cast<double>(expected))
      throw WaveContradiction(
          "only " + std::to_string(found) + " of " + std::to_string(expected) + " spots of " +
          name +
          " fit to the other cameras: check that it was not moved, that its image is "
          "not mirrored, and its starting intrinsics");
    if (found < kLeastSightings)
      throw WaveError("only " + std::to_string(found) + " spots of " + name +
                      " belong to the LED while another camera saw it, but " +
                      std::to_string(kLeastSightings) +
                      " are needed: wave longer where it and another camera see the LED");
  }
}

namespace {

/// Of a camera's time offset [s].
double offsetStddev(const geometry::Rig& rig, std::size_t camera) {
  const Eigen::Index k = geometry::firstParameter(camera) + geometry::kTimeOffset;
  return std::sqrt(rig.covariance(k, k));
}

void checkCorners(const square::Uncertainty& uncertainty, square::Solution* solution) {
  const std::optional<square::SuspectCorner>& suspect = solution->suspect;
  if (!suspect)
    return;
  double farthest = 0.0;  // in standard deviations
  for (std::size_t c = 0; c < solution->corner_offsets.size(); ++c)
    farthest = std::max(farthest, solution->corner_offsets[c].norm() / uncertainty.placementOf(c));
  const std::string corner = "corner " + std::to_string(suspect->corner + 1);
  const std::string off = format("%.0f mm", 1e3 * suspect->distance) + " beside its place";
  if (farthest > kRefuseDeviation)
    throw WaveContradiction(
        "the wave contradicts the square, most of all " + corner + ", which would have been " +
        off +
        ": check the sides of the square and that no camera moved, and capture the "
        "corners again");
  if (square::isDisplaced(*suspect))
    solution->warnings.push_back(corner + " seems to have been " + off +
                                 ": check the sides of the square and capture that corner again");
}

/// @throws WaveContradiction: a lens is far from its starting intrinsics.
void checkLenses(const Task& task, const geometry::Rig& rig) {
  double worst = square::kLensLimit;
  std::string worst_camera;
  for (std::size_t i = 0; i < task.recording.cameras.size(); ++i) {
    const square::CameraSightings& start = task.recording.cameras[i].sightings;
    const double deviation = square::marginalLensPrior(start.intrinsics, task.options.uncertainty)
                                 .deviation(rig.cameras[i].camera.intrinsics);
    if (deviation > worst) {
      worst = deviation;
      worst_camera = start.name;
    }
  }
  if (!worst_camera.empty())
    throw WaveContradiction("no lens near its starting intrinsics explains what " + worst_camera +
                            " saw: check them, that its image is not mirrored or turned, and that "
                            "the spots were the LED");
}

/// Of a camera, by its number.
/// @throws WaveContradiction: its accelerometer contradicts its pose. WaveError: its clock is not
/// known well enough.
void checkGravityAndClock(const Task& task, const square::Solution& solution, std::size_t i) {
  const Recording& recording = task.recording;
  const WaveOptions& options = task.options;
  const geometry::RigCamera& camera = solution.rig.cameras[i];
  const std::string& name = camera.camera.name;
  const auto tilt =
      recording.cameras[i].sightings.tilt(camera.camera.world_from_camera, solution.z_up);
  const bool is_level =
      recording.square || isOnFloor(recording) || recording.cameras.front().sightings.gravity;
  if (is_level && tilt && *tilt > square::kGravityLimit * options.uncertainty.gravity)
    throw WaveContradiction("the world as " + name + " sees it is tilted by " +
                            format("%.0f degrees", *tilt * 180.0 / M_PI) +
                            " against its accelerometer: its image is mirrored or turned, it was "
                            "moved, or the floor is not level");
  const double stddev = offsetStddev(solution.rig, i);
  if (stddev > options.maximum_offset_stddev)
    throw WaveError("the clock of " + name + " is known to " + format("%.2f ms", 1e3 * stddev) +
                    " only, not to " + format("%.2f ms", 1e3 * options.maximum_offset_stddev) +
                    ": wave faster than the " + format("%.1f m/s", solution.wave->median_speed) +
                    " it was, and longer where it sees the LED");
}

}  // namespace

void checkNoise(const WaveOptions& options, double pixel_stddev) {
  if (pixel_stddev > square::kRefuseRatio * options.pixel)
    throw WaveContradiction(
        "the cameras disagree by " + format("%.1f px", pixel_stddev) +
        ", far more than the stated " + format("%.1f px", options.pixel) +
        ": check that no camera was moved and that their times are of one clock");
}

void checkSolution(const Task& task, square::Solution* solution) {
  const Recording& recording = task.recording;
  const Eigen::Vector3d& extent = solution->wave->extent;
  if (extent.y() < kThinnestPath * extent.x())
    throw WaveError("the LED was moved along a line only: wave it through the whole volume");
  if (extent.z() < kThinnestPath * extent.x())
    throw WaveError("the LED was moved in a plane only, " + format("%.0f mm", 1e3 * extent.z()) +
                    " deep: wave it through the whole volume, also to the cameras and away");
  checkLenses(task, solution->rig);
  for (std::size_t i = 0; i < recording.cameras.size(); ++i)
    checkGravityAndClock(task, *solution, i);
  if (recording.square) {
    if (!solution->z_up)
      solution->warnings.emplace_back(square::kZDown);
    checkCorners(task.options.uncertainty, solution);
  }
  if (recording.square && recording.wand) {
    const double off = solution->wave->wand_length - recording.wand->length;
    if (std::abs(off) > kWarnDeviation * recording.wand->stddev)
      solution->warnings.push_back("by the square the wand is " +
                                   format("%.1f mm ", 1e3 * std::abs(off)) +
                                   (off > 0.0 ? "longer" : "shorter") +
                                   " than stated: measure the wand and the square again");
  }
}

namespace {

/// The world's name, and how level it is if that is measured.
std::string worldOf(const Recording& recording, const geometry::Rig& rig) {
  if (recording.square)
    return "the square's world";
  if (!isOnFloor(recording))
    return "the first camera's world";
  const double tilt = std::sqrt(rig.covariance(0, 0) + rig.covariance(1, 1));
  return format("the wand's world, level to %.1f degrees", tilt * 180.0 / M_PI);
}

}  // namespace

std::string describe(const Recording& recording, const square::Solution& solution) {
  double worst_px = 0.0;
  double worst_offset = 0.0;
  for (std::size_t i = 0; i < solution.rig.cameras.size(); ++i) {
    worst_px = std::max(worst_px, solution.rig.cameras[i].residual_px);
    worst_offset = std::max(worst_offset, offsetStddev(solution.rig, i));
  }
  std::string text = format(
      "%zu cameras solved from %.0f s of %s%s; residuals at most %.2f px, time offsets known to "
      "%.2f ms",
      solution.rig.cameras.size(), solution.wave->seconds_seen,
      recording.wand ? "a wand" : "a wave", recording.square ? " and the square" : "", worst_px,
      1e3 * worst_offset);
  if (std::isfinite(solution.expected_error))
    text += format(
        "; points where the LED was waved expected within %.1f mm (RMS) in %s, %.1f mm to one "
        "another",
        1e3 * solution.expected_error, worldOf(recording, solution.rig).c_str(),
        1e3 * solution.wave->expected_shape_error);
  return text;
}

}  // namespace wiimote_tracker::wave
