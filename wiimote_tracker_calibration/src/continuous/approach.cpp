#include "continuous/approach.h"

#include "adjust/camera_blocks.h"

#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/sight.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>
#include <wiimote_tracker_triangulation/geometry/triangulate.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace wiimote_tracker::continuous {

double movementOf(const geometry::Rig& from,
                  const geometry::Rig& to,
                  const std::vector<Eigen::Vector3d>& places) {
  double farthest = 0.0;
  std::vector<geometry::Sight> sights;
  for (const Eigen::Vector3d& place : places) {
    sights.clear();
    for (std::size_t i = 0; i < from.cameras.size(); ++i) {
      const geometry::Camera camera = from.rayCamera(from.cameras[i]);
      if (!camera.sees(place))
        continue;
      const auto pixel = camera.project(place);
      if (const auto sight = geometry::sightFromPixel(to.rayCamera(to.cameras[i]), *pixel))
        sights.push_back(*sight);
    }
    if (const auto point = geometry::triangulate(sights.data(), sights.size(), {}))
      farthest = std::max(farthest, (point->position - place).norm());
  }
  return farthest;
}

geometry::Rig between(const geometry::Rig& from, const geometry::Rig& to, double share) {
  geometry::Rig rig = to;
  // What is left of the way, in the order of the rig's covariance.
  Eigen::VectorXd left = Eigen::VectorXd::Zero(geometry::firstParameter(to.cameras.size()));
  for (std::size_t i = 0; i < to.cameras.size(); ++i) {
    const geometry::Camera& start = from.cameras[i].camera;
    geometry::Camera& camera = rig.cameras[i].camera;
    adjust::CameraBlocks then(start);
    Eigen::Vector3d::Map(then.rotation()) = geometry::so3::log(
        start.world_from_camera.linear() * camera.world_from_camera.linear().transpose());
    adjust::CameraBlocks now(camera);
    for (std::size_t k = 0; k < now.values.size(); ++k) {
      double& back = left[geometry::firstParameter(i) + static_cast<Eigen::Index>(k)];
      back = (1.0 - share) * (then.values[k] - now.values[k]);
      now.values[k] += back;
    }
    camera = now.cameraLike(camera);
  }
  if (geometry::hasCovariance(rig))
    rig.covariance += left * left.transpose();
  return rig;
}

std::optional<geometry::Rig> Approach::step(const geometry::Rig& in_use, double stamp) {
  if (is_reached_ || std::abs(stamp - last_step_) < kPeriod)
    return std::nullopt;
  last_step_ = stamp;
  const double way = movementOf(in_use, goal_, places_);
  is_reached_ = way <= kLongestStep;
  return is_reached_ ? goal_ : between(in_use, goal_, kLongestStep / way);
}

geometry::Rig Approach::changeGoal(const geometry::Rig& goal,
                                   const std::vector<std::string>& knocked,
                                   const geometry::Rig& in_use) {
  goal_ = goal;
  is_reached_ = false;
  geometry::Rig from = in_use;
  for (std::size_t i = 0; i < goal.cameras.size(); ++i) {
    if (std::count(knocked.begin(), knocked.end(), goal.cameras[i].camera.name) > 0)
      from.cameras[i].camera = goal.cameras[i].camera;
  }
  return between(from, goal, 0.0);
}

}  // namespace wiimote_tracker::continuous
