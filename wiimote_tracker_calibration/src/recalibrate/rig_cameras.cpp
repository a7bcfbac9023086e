#include "rig_cameras.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/shared_views.h>
#include <wiimote_tracker_triangulation/geometry/sight.h>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace wiimote_tracker::recalibrate {

using geometry::firstParameter;

geometry::Rig withCamera(const geometry::Rig& rig, const std::string& name) {
  geometry::Rig result = rig;
  result.cameras.emplace_back().camera.name = name;
  const Eigen::Index size = firstParameter(result.cameras.size());
  if (geometry::hasCovariance(rig))
    result.covariance.conservativeResizeLike(Eigen::MatrixXd::Zero(size, size));
  return result;
}

geometry::Rig withoutCamera(const geometry::Rig& rig, const std::string& name) {
  const geometry::RigCamera* const camera = rig.find(name);
  if (!camera) {
    std::vector<std::string> names;
    for (const geometry::RigCamera& each : rig.cameras)
      names.push_back(each.camera.name);
    throw Error("the rig has no camera '" + name + "': name one of " + joined(names));
  }
  if (rig.cameras.size() <= 2)
    throw Error("a rig needs two cameras: add another one before you remove " + name);
  const auto index = static_cast<std::size_t>(camera - rig.cameras.data());
  geometry::Rig result = rig;
  result.cameras.erase(result.cameras.begin() + static_cast<std::ptrdiff_t>(index));
  if (geometry::hasCovariance(rig)) {
    Eigen::MatrixXd& covariance = result.covariance;
    const Eigen::Index first = firstParameter(index);
    const Eigen::Index after = covariance.rows() - firstParameter(index + 1);
    covariance.middleRows(first, after) = covariance.bottomRows(after).eval();
    covariance.middleCols(first, after) = covariance.rightCols(after).eval();
    covariance.conservativeResize(first + after, first + after);
  }
  return result;
}

std::string describeSplit(const geometry::Rig& rig, const std::string& name) {
  auto shared = geometry::sharedViews(rig, geometry::kFarthestLed);
  const auto removed = static_cast<std::size_t>(rig.find(name) - rig.cameras.data());
  const std::vector<std::size_t> partners = std::exchange(shared[removed], {});
  for (std::vector<std::size_t>& others : shared)
    others.erase(std::remove(others.begin(), others.end(), removed), others.end());
  std::vector<std::string> parts;
  for (const std::vector<std::size_t>& group : geometry::groupsOf(shared)) {
    std::vector<std::string> names;
    for (const std::size_t camera : group)
      names.push_back(rig.cameras[camera].camera.name);
    if (std::find_first_of(group.begin(), group.end(), partners.begin(), partners.end()) !=
        group.end())
      parts.push_back(joined(names));
  }
  if (parts.size() < 2)
    return "";
  return name + " alone linked the views of " + joined(parts, " with those of ") +
         ": an LED that goes from one to the other is lost on the way; add it again, or turn "
         "another camera so that it sees both, and recalibrate that";
}

std::string describeOldMasks(const geometry::Rig& before, const geometry::Rig& now) {
  constexpr double kLampDistance = 3.0;  // [m]
  std::vector<std::string> moved;
  for (const geometry::RigCamera& camera : now.cameras) {
    const geometry::RigCamera* const then = before.find(camera.camera.name);
    const bool misses =
        std::any_of(camera.masks.begin(), camera.masks.end(), [&](const geometry::ImageMask& mask) {
          if (!then)
            return false;
          const auto sight = geometry::sightFromPixel(then->camera, mask.center);
          const auto lamp =
              sight ? camera.camera.project(sight->origin + kLampDistance * sight->direction)
                    : std::nullopt;
          return !lamp || (*lamp - mask.center).norm() > mask.radius;
        });
    if (misses)
      moved.push_back(camera.camera.name);
  }
  if (moved.empty())
    return "";
  return "; the masks of " + joined(moved) +
         " cover where lamps were before: switch the LED off, and learn the lights again";
}

}  // namespace wiimote_tracker::recalibrate
