#include "wiimote_tracker_triangulation/remap/correction.h"

#include "wiimote_tracker_triangulation/geometry/error.h"

#include <cmath>

namespace wiimote_tracker::remap {
namespace {

Eigen::Vector3d meanOf(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points)
    sum += point;
  return sum / static_cast<double>(points.size());
}

}  // namespace

Correction::Correction(const Remap& remap, const std::string& rig_id) : remap_(remap) {
  if (remap.rig_id.empty() || remap.rig_id != rig_id)
    throw Error("the correction of the volume was measured with calibration \"" + remap.rig_id +
                "\", but the rig is \"" + rig_id +
                "\": it is void; measure the known points again");
  remap.check();
  frame_ = frameOf(remap.support);
  hull_ = ConvexHull(remap.support);
  if (std::isinf(hull_.excess(frame_.middle)))
    throw Error(
        "the points of the correction of the volume enclose no volume: it is damaged; measure "
        "the known points again");
  middle_ = meanOf(remap.support);
  // A projective model's denominator is linear: if positive at all corners, it is positive in the
  // hull.
  for (const Eigen::Vector3d& point : remap.support) {
    if (!evaluate(remap, frame_, point))
      throw Error(
          "the correction of the volume maps points of its own support to infinity: it is "
          "damaged; measure the known points again");
  }
}

std::optional<CorrectedPoint> Correction::apply(const Eigen::Vector3d& measured,
                                                const Eigen::Matrix3d& covariance) const {
  if (!measured.allFinite())
    return std::nullopt;
  CorrectedPoint point;
  point.inside = hull_.encloses(measured);
  // Point whose displacement is used.
  Eigen::Vector3d place = measured;
  Eigen::Matrix3d place_by_measured = Eigen::Matrix3d::Identity();
  if (!point.inside) {
    const ConvexHull::Exit exit = hull_.exit(middle_, measured);
    const Eigen::Vector3d way = measured - middle_;
    place = middle_ + exit.share * way;
    place_by_measured -= way * exit.normal.transpose() / exit.normal.dot(way);
    place_by_measured *= exit.share;
  }
  const std::optional<Mapped> mapped = evaluate(remap_, frame_, place);
  if (!mapped)
    return std::nullopt;
  point.position = measured + (mapped->position - place);
  point.jacobian = Eigen::Matrix3d::Identity() +
                   (mapped->jacobian - Eigen::Matrix3d::Identity()) * place_by_measured;
  point.covariance = point.jacobian * covariance * point.jacobian.transpose();
  return point;
}

}  // namespace wiimote_tracker::remap
