#include "continuous/approach.h"

#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/sight.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>
#include <wiimote_tracker_triangulation/geometry/triangulate.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace wiimote_tracker::continuous {

namespace {

using geometry::firstParameter;
namespace so3 = geometry::so3;

using Parameters = Eigen::Matrix<double, geometry::kParameters, 1>;

Parameters lensOf(const geometry::Intrinsics& lens) {
  Parameters parameters = Parameters::Zero();
  parameters.segment<4>(geometry::kIntrinsics) << lens.fx, lens.fy, lens.cx, lens.cy;
  parameters.segment<5>(geometry::kDistortion) =
      Eigen::Map<const Eigen::Matrix<double, 5, 1>>(lens.distortion.data());
  return parameters;
}

/// What has to be added to a camera's parameters to get those of another.
Parameters differenceOf(const geometry::Camera& from, const geometry::Camera& to) {
  Parameters difference = lensOf(to.intrinsics) - lensOf(from.intrinsics);
  difference.segment<3>(geometry::kRotation) =
      so3::log(to.world_from_camera.linear() * from.world_from_camera.linear().transpose());
  difference.segment<3>(geometry::kPosition) = to.center() - from.center();
  return difference;
}

void add(const Parameters& difference, geometry::Camera* camera) {
  Eigen::Isometry3d& pose = camera->world_from_camera;
  pose.linear() =
      so3::exp(difference.segment<3>(geometry::kRotation)).toRotationMatrix() * pose.linear();
  pose.translation() += difference.segment<3>(geometry::kPosition);
  geometry::Intrinsics& lens = camera->intrinsics;
  lens.fx += difference[geometry::kIntrinsics];
  lens.fy += difference[geometry::kIntrinsics + 1];
  lens.cx += difference[geometry::kIntrinsics + 2];
  lens.cy += difference[geometry::kIntrinsics + 3];
  for (std::size_t i = 0; i < lens.distortion.size(); ++i)
    lens.distortion[i] += difference[geometry::kDistortion + static_cast<Eigen::Index>(i)];
}

}  // namespace

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
  Eigen::VectorXd left(geometry::kParameters * static_cast<Eigen::Index>(to.cameras.size()));
  for (std::size_t i = 0; i < to.cameras.size(); ++i) {
    const Parameters way = differenceOf(from.cameras[i].camera, to.cameras[i].camera);
    left.segment<geometry::kParameters>(firstParameter(i)) = (1.0 - share) * way;
    add((share - 1.0) * way, &rig.cameras[i].camera);
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
