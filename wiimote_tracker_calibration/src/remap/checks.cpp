#include "checks.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>

#include <Eigen/LU>

namespace wiimote_tracker::remap {

namespace {

constexpr std::size_t kFewest = 6;
constexpr std::size_t kMost = 500;
// A standard deviation below this share of the largest means that the points are flat.
constexpr double kFlat = 0.03;

void checkSpread(const std::vector<Eigen::Vector3d>& points, const std::string& which) {
  const Eigen::Vector3d spread = geometry::spreadOf(points);
  if (spread[1] < kFlat * spread[0])
    throw Error("the " + which +
                " points lie on one line: add points to its sides and at other heights");
  if (spread[2] < kFlat * spread[0])
    throw Error("the " + which +
                " points lie in one plane: add points off it, for example at other heights");
}

}  // namespace

void checkPoints(const std::vector<KnownPoint>& points) {
  if (points.size() < kFewest)
    throw Error(std::to_string(points.size()) +
                " known points are too few for any correction of the volume: measure at least "
                "6, better the 8 corners of the volume and some inside");
  if (points.size() > kMost)
    throw Error(std::to_string(points.size()) +
                " known points are more than can be handled: choose at most 500");
  std::vector<Eigen::Vector3d> known;
  std::vector<Eigen::Vector3d> measured;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const KnownPoint& point : points) {
    known.push_back(point.known);
    measured.push_back(point.measured);
    mean += point.measured / static_cast<double>(points.size());
  }
  checkSpread(known, "known");
  checkSpread(measured, "measured");
  Eigen::Matrix3d correlation = Eigen::Matrix3d::Zero();
  for (const KnownPoint& point : points)
    correlation += (point.measured - mean) * point.known.transpose();
  if (correlation.determinant() < 0.0)
    throw Error(
        "the measured points are the mirror image of the known ones: check the axes and the signs "
        "of the known places, and that none are exchanged");
}

}  // namespace wiimote_tracker::remap
