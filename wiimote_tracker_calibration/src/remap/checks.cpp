#include "checks.h"

#include <wiimote_tracker_msgs/error.h>

#include <Eigen/LU>
#include <Eigen/SVD>

namespace wiimote_tracker::remap {

namespace {

constexpr std::size_t kFewest = 6;
constexpr std::size_t kMost = 500;
// Known places closer than this are the same place [m].
constexpr double kSamePlace = 0.001;
// A standard deviation below this share of the largest means that the points are flat.
constexpr double kFlat = 0.03;

Eigen::MatrixXd centered(const std::vector<KnownPoint>& points, bool known) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(points.size()), 3);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const KnownPoint& point = points[static_cast<std::size_t>(i)];
    rows.row(i) = (known ? point.known : point.measured).transpose();
  }
  const Eigen::RowVector3d mean = rows.colwise().mean();
  return rows.rowwise() - mean;
}

void checkSpread(const Eigen::MatrixXd& rows, const std::string& which) {
  const Eigen::VectorXd spread = Eigen::JacobiSVD<Eigen::MatrixXd>(rows).singularValues();
  if (spread[1] < kFlat * spread[0])
    throw Error("the " + which +
                " points lie on one line: add points to its sides and at other heights");
  if (spread[2] < kFlat * spread[0])
    throw Error("the " + which +
                " points lie in one plane: add points off it, for example at other heights");
}

}  // namespace

void checkPoints(const std::vector<KnownPoint>& points, const std::string& rig_id) {
  if (rig_id.empty())
    throw Error(
        "the points belong to no calibration: calibrate the rig first, then measure them with it");
  if (points.size() < kFewest)
    throw Error(std::to_string(points.size()) +
                " known points are too few for any correction of the volume: measure at least "
                "6, better the 8 corners of the volume and some inside");
  if (points.size() > kMost)
    throw Error(std::to_string(points.size()) +
                " known points are more than can be handled: choose at most 500");
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].known.allFinite() || !points[i].measured.allFinite())
      throw Error("known point " + std::to_string(i + 1) +
                  " is not finite: measure it again, or leave it out");
    for (std::size_t j = 0; j < i; ++j) {
      if ((points[i].known - points[j].known).norm() < kSamePlace)
        throw Error("known points " + std::to_string(j + 1) + " and " + std::to_string(i + 1) +
                    " are one place: give each place once, with the mean of what was measured "
                    "there");
    }
  }
  const Eigen::MatrixXd known = centered(points, true);
  const Eigen::MatrixXd measured = centered(points, false);
  checkSpread(known, "known");
  checkSpread(measured, "measured");
  if ((measured.transpose() * known).determinant() < 0.0)
    throw Error(
        "the measured points are the mirror image of the known ones: check the axes and the signs "
        "of the known places, and that none are exchanged");
}

}  // namespace wiimote_tracker::remap
