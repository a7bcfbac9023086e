#include "lens_check.h"

#include "callbacks.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace wiimote_tracker {
namespace {

// Largest difference in pixels of the same direction of two equal lenses [px].
constexpr double kSameLens = 2.0;

std::optional<geometry::Intrinsics> lensOf(const sensor_msgs::CameraInfo& info) {
  const auto model = geometry::distortionModelFromName(info.distortion_model);
  if (!model || info.D.size() != geometry::coefficientCount(*model))
    return std::nullopt;
  geometry::Intrinsics lens;
  lens.width = static_cast<int>(info.width);
  lens.height = static_cast<int>(info.height);
  lens.fx = info.K[0];
  lens.cx = info.K[2];
  lens.fy = info.K[4];
  lens.cy = info.K[5];
  lens.distortion_model = *model;
  std::copy(info.D.begin(), info.D.end(), lens.distortion.begin());
  return lens;
}

/// Largest distance between the pixels of the same direction over the image [px]; not finite when
/// b does not map a direction.
double distanceOf(const geometry::Intrinsics& a, const geometry::Intrinsics& b) {
  constexpr int kSteps = 8;
  double largest = 0.0;
  for (int x = 0; x <= kSteps; ++x) {
    for (int y = 0; y <= kSteps; ++y) {
      const Eigen::Vector2d pixel(x * (a.width - 1.0) / kSteps, y * (a.height - 1.0) / kSteps);
      if (const auto direction = a.normalizedFromPixel(pixel)) {
        const double distance = (b.pixelFromNormalized(*direction) - pixel).norm();
        if (!std::isfinite(distance))
          return distance;
        largest = std::max(largest, distance);
      }
    }
  }
  return largest;
}

}  // namespace

std::string lensMismatch(const sensor_msgs::CameraInfo& info, const geometry::Camera& calibrated) {
  if (info.K[0] == 0.0)
    return "";
  const std::string what_to_do =
      "; the tracker uses the rig. Calibrate again if that lens is right; else save the rig "
      "without "
      "a name, which replaces it";
  const geometry::Intrinsics& rig = calibrated.intrinsics;
  if (static_cast<int>(info.width) != rig.width || static_cast<int>(info.height) != rig.height)
    return "camera_info of " + calibrated.name + " has another image size than the rig" +
           what_to_do;
  const auto lens = lensOf(info);
  if (!lens)
    return "camera_info of " + calibrated.name + " has a lens model '" + info.distortion_model +
           "' with " + std::to_string(info.D.size()) + " coefficients, which is unknown" +
           what_to_do;
  const double distance = distanceOf(rig, *lens);
  if (distance <= kSameLens)
    return "";
  return format("camera_info of %s contradicts the rig by up to %g px%s", calibrated.name.c_str(),
                distance, what_to_do.c_str());
}

void LensCheck::setRig(const geometry::Rig& rig) {
  subscribers_.clear();
  problems_.clear();
  if (rig.solved_at > begin_)
    return;
  for (const geometry::RigCamera& rig_camera : rig.cameras) {
    const geometry::Camera& camera = rig_camera.camera;
    subscribers_[camera.name] = subscribe<sensor_msgs::CameraInfo>(
        nh_, camera.name + "/camera_info", 1,
        [this, camera](const auto& event) { compare(*event.getConstMessage(), camera); });
  }
}

void LensCheck::compare(const sensor_msgs::CameraInfo& info, const geometry::Camera& calibrated) {
  const std::string problem = lensMismatch(info, calibrated);
  std::string& known = problems_[calibrated.name];
  if (known.empty() && !problem.empty())
    ROS_WARN("%s.", problem.c_str());
  known = problem;
  // The queue keeps this callback alive until it returns.
  if (problem.empty())
    subscribers_.erase(calibrated.name);
}

std::string LensCheck::problemOf(const std::string& camera) const {
  const auto found = problems_.find(camera);
  return found != problems_.end() ? found->second : "";
}

}  // namespace wiimote_tracker
