#include "judge.h"

#include "next_measurement.h"
#include "square/expected_error.h"
#include "square/usable_cameras.h"

#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/triangulate.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace wiimote_tracker::samples {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
// Height of the paper's cube above the corners [m].
constexpr double kAbove = 2.5;
// Limits of a point's predicted error, as a share of its distance from the cameras
// (doc/samples.md).
constexpr double kGoodShare = 0.004;
constexpr double kUsableShare = 0.02;
// Chi-squared difference between the worst corner and the next: a likelihood ratio of 100.
constexpr double kClearLead = 9.2;
// Least share of inliers of a camera that is good.
constexpr double kGoodInliers = 0.8;

// Nearest LED that a Wii Remote sees [m].
constexpr double kNearestLed = 0.3;

std::string millimetres(double value) {
  return format(value < 0.001 ? "%.1f mm" : "%.0f mm", 1e3 * value);
}

CameraVerdict judgeCamera(const geometry::Rig& rig, std::size_t index) {
  const geometry::RigCamera& camera = rig.cameras[index];
  CameraVerdict verdict;
  verdict.name = camera.camera.name;
  verdict.residual_px = camera.residual_px;
  verdict.residual_m = camera.residual_m;
  verdict.inlier_share =
      camera.observations > 0 ? static_cast<double>(camera.inliers) / camera.observations : kNan;
  const Eigen::Index first = geometry::firstParameter(index);
  const auto variance = [&](Eigen::Index parameter) {
    return geometry::hasCovariance(rig) ? rig.covariance(first + parameter, first + parameter)
                                        : kNan;
  };
  const auto rootOfTrace = [&](Eigen::Index begin) {
    return std::sqrt(variance(begin) + variance(begin + 1) + variance(begin + 2));
  };
  verdict.rotation_stddev = rootOfTrace(geometry::kRotation);
  verdict.position_stddev = rootOfTrace(geometry::kPosition);
  verdict.focal_stddev =
      std::sqrt(std::max(variance(geometry::kIntrinsics), variance(geometry::kIntrinsics + 1)));
  verdict.principal_point_stddev =
      std::sqrt(std::max(variance(geometry::kIntrinsics + 2), variance(geometry::kIntrinsics + 3)));
  verdict.k1_stddev = std::sqrt(variance(geometry::kDistortion));
  verdict.time_offset_stddev =
      std::isnan(camera.time_offset) ? kNan : std::sqrt(variance(geometry::kTimeOffset));
  return verdict;
}

/// RMS distance of the corners, triangulated with the rig from their captured spots, from their
/// nominal places, over those that two cameras saw [m]; NaN when there is none.
double cornerError(const Samples& samples, const geometry::Rig& rig, bool z_up) {
  const square::Corners nominal = samples.recording.square->corners(z_up);
  const std::vector<geometry::Camera> cameras = rig.rayCameras();
  double sum = 0.0;
  int count = 0;
  for (std::size_t c = 0; c < nominal.size(); ++c) {
    std::vector<geometry::Observation> observations;
    for (const geometry::Camera& camera : cameras) {
      for (const wave::CameraRecording& recorded : samples.recording.cameras) {
        const auto& pixel = recorded.sightings.corners[c];
        if (recorded.sightings.name == camera.name && pixel)
          observations.push_back({&camera, *pixel});
      }
    }
    const auto point = geometry::triangulate(observations, {});
    if (!point)
      continue;
    sum += (point->position - nominal[c]).squaredNorm();
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : kNan;
}

/// Mean distance of the cameras from a place [m].
double meanDistance(const geometry::Rig& rig, const Eigen::Vector3d& place) {
  double sum = 0.0;
  for (const geometry::RigCamera& camera : rig.cameras)
    sum += (camera.camera.center() - place).norm();
  return sum / static_cast<double>(rig.cameras.size());
}

/// Fills predicted_at and what follows.
void predict(const square::SquareLayout& layout,
             const square::Solution& found,
             double pixel,
             Verdict* verdict) {
  const geometry::Rig& rig = found.rig;
  const square::Corners corners = layout.corners(found.z_up);
  const Eigen::Vector3d above(0.0, 0.0, found.z_up ? kAbove : -kAbove);
  verdict->predicted_at.assign(corners.begin(), corners.end());
  for (const Eigen::Vector3d& corner : corners)
    verdict->predicted_at.push_back(corner + above);
  verdict->predicted_stddev.assign(verdict->predicted_at.size(), kNan);
  if (rig.ray_model != geometry::RayModel::kCalibrated)
    return;
  for (std::size_t i = 0; i < verdict->predicted_at.size(); ++i)
    verdict->predicted_stddev[i] = square::expectedError(rig, {verdict->predicted_at[i]});
  verdict->expected_error = square::expectedError(rig, verdict->predicted_at);
  if (found.joint_covariance.size() > 0)  // else the corners were taken as exact
    verdict->next = nextMeasurement(found, layout, verdict->predicted_at, pixel);
}

/// How accurate points are.
struct Accuracy {
  double share = kNan;  ///< Largest error as a share of the distance.
  std::string text;
};

Accuracy accuracyOf(const Samples& samples, const square::Solution& found, const Verdict& verdict) {
  const geometry::Rig& rig = found.rig;
  Accuracy accuracy;
  if (!samples.recording.square) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& place : found.path)
      middle += place / static_cast<double>(found.path.size());
    accuracy.share = found.wave->expected_shape_error / meanDistance(rig, middle);
    accuracy.text = "points are known to " + millimetres(found.wave->expected_shape_error) +
                    " to one another (RMS where the LED was waved)";
    return accuracy;
  }
  if (rig.ray_model == geometry::RayModel::kImageCenter) {
    const double error = cornerError(samples, rig, found.z_up);
    accuracy.share = error / meanDistance(rig, verdict.predicted_at[0]);
    accuracy.text = "the corners are measured " + millimetres(error) +
                    " beside their places (RMS), and points elsewhere farther off, because the "
                    "rays of the image_center model are not those of the calibrated lenses";
    return accuracy;
  }
  double below = kNan;
  double above = kNan;
  for (std::size_t i = 0; i < verdict.predicted_at.size(); ++i) {
    const double stddev = verdict.predicted_stddev[i];
    double& largest = i < 4 ? below : above;
    largest = std::fmax(largest, stddev);  // ignores NaN
    accuracy.share = std::fmax(accuracy.share, stddev / meanDistance(rig, verdict.predicted_at[i]));
  }
  if (std::isfinite(below))
    accuracy.text = "points are known to " + millimetres(below) + " at the worst corner";
  if (std::isfinite(above))
    accuracy.text += (accuracy.text.empty() ? "points are known to " : " and ") +
                     millimetres(above) + " at the worst place 2.5 m above one";
  if (accuracy.text.empty())
    accuracy.text = "no two cameras look at a corner or at 2.5 m above one";
  return accuracy;
}

/// What would make the rig more accurate.
std::string improvement(const wave::Recording& recording) {
  return std::string(recording.hasFrames() ? "wave longer, through the whole volume"
                                           : "wave an LED or a wand through the volume") +
         (recording.square ? ", or use a larger square" : "");
}

bool concernsQuality(const std::string& warning) {
  return warning != square::kZDown;
}

/// Why the rig is not good, or empty. @param question scaleQuestion().
std::vector<std::string> shortcomings(const Samples& samples,
                                      const std::string& question,
                                      const Accuracy& accuracy,
                                      const square::Solution& found,
                                      const Verdict& verdict) {
  std::vector<std::string> reasons;
  if (!question.empty())
    reasons.push_back(question);
  if (!(accuracy.share <= kGoodShare))
    reasons.push_back(
        std::isnan(accuracy.share)
            ? std::string("its accuracy is unknown: point two cameras or more at the square")
            : "it is not as accurate as it could be: " + improvement(samples.recording));
  for (const CameraVerdict& camera : verdict.cameras) {
    if (camera.inlier_share < kGoodInliers)
      reasons.push_back(
          format("%.0f %%", 100.0 * (1.0 - camera.inlier_share)) + " of what " + camera.name +
          " saw was not the LED: cover lamps and reflections, and see whether its clock jumped");
  }
  if (std::any_of(found.warnings.begin(), found.warnings.end(), concernsQuality))
    reasons.emplace_back("read the warnings");
  return reasons;
}

/// Which corner to redo, and why.
std::string suspectText(const square::SuspectCorner& suspect) {
  std::string text = "corner " + std::to_string(suspect.corner + 1);
  if (suspect.runner_up && suspect.lead < kClearLead)
    text += " or " + std::to_string(*suspect.runner_up + 1);
  return text + ": the other data put the LED " + millimetres(suspect.distance) +
         " beside it; put it there again, capture that corner again and solve";
}

}  // namespace

std::string scaleQuestion(const wave::Recording& recording,
                          const geometry::Rig& rig,
                          const std::vector<Eigen::Vector3d>& led) {
  for (const geometry::RigCamera& camera : rig.cameras) {
    double distance = 0.0;
    for (const Eigen::Vector3d& place : led)
      distance += (place - camera.camera.center()).norm() / static_cast<double>(led.size());
    if (led.empty() || (distance >= kNearestLed && distance <= geometry::kFarthestLed))
      continue;
    const auto& square = recording.square;
    return camera.camera.name +
           format(" would be %.3g m from the LED, but a Wii Remote sees one at %g to %g m: is ",
                  distance, kNearestLed, geometry::kFarthestLed) +
           (square ? format("the square really %g m by %g m", square->side_x, square->side_y)
                   : format("the wand really %g m long", recording.wand->length)) +
           "? Give lengths in metres";
  }
  return "";
}

Verdict verdictOf(const geometry::Rig& rig) {
  Verdict verdict;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i)
    verdict.cameras.push_back(judgeCamera(rig, i));
  verdict.text = rig.verdict;
  verdict.grade = gradeOf(rig.verdict);
  return verdict;
}

Verdict judge(const Samples& samples, const square::Solution& found, double pixel) {
  Verdict verdict = verdictOf(found.rig);
  if (samples.recording.square)
    predict(*samples.recording.square, found, pixel, &verdict);
  const Accuracy accuracy = accuracyOf(samples, found, verdict);
  const std::string question = scaleQuestion(samples.recording, found.rig, found.path);
  verdict.doubts_scale = !question.empty();
  const auto reasons = shortcomings(samples, question, accuracy, found, verdict);
  std::string reason;
  if (found.suspect && square::isDisplaced(*found.suspect)) {
    verdict.grade = Grade::kRedo;
    verdict.redo_corner = found.suspect->corner;
    reason = " " + suspectText(*found.suspect);
  } else if (accuracy.share > kUsableShare) {
    verdict.grade = Grade::kRedo;
    reason =
        ": points would be far off; place the cameras so that they look from different sides, "
        "and " +
        improvement(samples.recording);
  } else if (!reasons.empty()) {
    verdict.grade = Grade::kUsable;
    reason = ": " + joined(reasons, ", and ");
  } else {
    verdict.grade = Grade::kGood;
  }
  verdict.text = nameOf(verdict.grade) + reason;
  if (!accuracy.text.empty())
    verdict.text += "; " + accuracy.text;
  verdict.text += "; " + found.rig.verdict;
  for (const std::string& warning : found.warnings)
    verdict.text += "; warning: " + warning;
  return verdict;
}

}  // namespace wiimote_tracker::samples
