#include "wiimote_tracker_triangulation/geometry/calibration_uncertainty.h"

#include "wiimote_tracker_triangulation/geometry/point_sensitivity.h"

#include <boost/functional/hash.hpp>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::geometry {
namespace {

using Matrix3 = Eigen::Matrix3d;
using Vector3 = Eigen::Vector3d;

constexpr double kCellSize = 0.2;     // [m]
constexpr std::size_t kCells = 1024;  // remembered at once
constexpr double kFarthest = 1e6;     // [m]

}  // namespace

CalibrationUncertainty::CalibrationUncertainty(const Rig& rig) : rig_(rig), cells_(kCells) {}

std::optional<Matrix3> CalibrationUncertainty::covarianceOf(const Vector3& point,
                                                            const std::size_t* cameras,
                                                            std::size_t count) const {
  count = std::min(count, kMaximumCameras);
  if (!hasCovariance(rig_) || count < 2)
    return std::nullopt;
  std::array<PointJacobian, kMaximumCameras> by_camera;
  if (!pointSensitivity(rig_, point, cameras, count, by_camera.data()))
    return std::nullopt;
  const Matrix3 covariance = propagatedErrors(rig_.covariance, by_camera.data(), cameras, count);
  return covariance.allFinite() ? std::make_optional(covariance) : std::nullopt;
}

std::optional<Matrix3> CalibrationUncertainty::covarianceNear(const Vector3& point,
                                                              const std::size_t* cameras,
                                                              std::size_t count) {
  count = std::min(count, kMaximumCameras);
  if (!hasCovariance(rig_) || count < 2 || !(point.cwiseAbs().maxCoeff() < kFarthest))
    return std::nullopt;
  std::array<std::int32_t, 3> place;
  for (int i = 0; i < 3; ++i)
    place[i] = static_cast<std::int32_t>(std::floor(point[i] / kCellSize));
  std::size_t hash = boost::hash_range(place.begin(), place.end());
  boost::hash_range(hash, cameras, cameras + count);
  Cell& cell = cells_[hash % kCells];
  if (cell.known && cell.place == place && cell.count == count &&
      std::equal(cameras, cameras + count, cell.cameras.begin()))
    return cell.covariance;

  Vector3 middle;
  for (int i = 0; i < 3; ++i)
    middle[i] = kCellSize * (place[i] + 0.5);
  cell.covariance = covarianceOf(middle, cameras, count);
  cell.place = place;
  cell.count = count;
  std::copy(cameras, cameras + count, cell.cameras.begin());
  cell.known = true;
  return cell.covariance;
}

}  // namespace wiimote_tracker::geometry
