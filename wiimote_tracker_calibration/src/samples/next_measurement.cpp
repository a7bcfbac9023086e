#include "next_measurement.h"

#include "square/expected_error.h"

#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/point_sensitivity.h>

#include <cmath>
#include <string>

namespace wiimote_tracker::samples {

namespace {

// A measurement that gains less is not worth the walk.
constexpr double kLeastGain = 0.05;

/// Derivatives of what is measured by the parameters, one row each, and covariance of its noise.
struct MeasurementModel {
  Eigen::MatrixXd by_parameters;
  Eigen::MatrixXd covariance;
};

MeasurementModel lengthBetween(const square::Corners& corners,
                               std::size_t from,
                               std::size_t to,
                               Eigen::Index parameters) {
  const Eigen::RowVector2d direction =
      (corners[to] - corners[from]).normalized().head<2>().transpose();
  const auto at = [&](std::size_t corner) {
    return parameters - square::kCornerParameters + 2 * static_cast<Eigen::Index>(corner);
  };
  MeasurementModel length{
      Eigen::MatrixXd::Zero(1, parameters),
      Eigen::MatrixXd::Constant(1, 1, std::pow(square::TapedLength().stddev, 2))};
  length.by_parameters.block<1, 2>(0, at(from)) = -direction;
  length.by_parameters.block<1, 2>(0, at(to)) = direction;
  return length;
}

/// The pixels of the LED on a known place, in the cameras that see it.
MeasurementModel pixelsOf(const geometry::Rig& rig,
                          const Eigen::Vector3d& place,
                          double pixel,
                          Eigen::Index parameters) {
  const std::vector<std::size_t> cameras = geometry::camerasSeeing(rig, place);
  const auto rows = 2 * static_cast<Eigen::Index>(cameras.size());
  Eigen::MatrixXd by_place(rows, 3);
  MeasurementModel pixels{Eigen::MatrixXd::Zero(rows, parameters),
                          pixel * pixel * Eigen::MatrixXd::Identity(rows, rows)};
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const auto row = 2 * static_cast<Eigen::Index>(i);
    const auto projection = geometry::rayProjection(rig, cameras[i], place);
    by_place.middleRows<2>(row) = projection->by_point;
    pixels.by_parameters.block<2, geometry::kParameters>(
        row, geometry::firstParameter(cameras[i])) = projection->by_parameters;
  }
  pixels.covariance += std::pow(square::KnownPlace().stddev, 2) * by_place * by_place.transpose();
  return pixels;
}

/// Places over the square, to which a person can carry the LED: its corners, the middles of its
/// sides, and its middle, on the floor, 1 m and 2 m high.
std::vector<Eigen::Vector3d> placesOver(const square::Corners& corners, bool z_up) {
  std::vector<Eigen::Vector3d> places;
  for (const double height : {0.0, 1.0, 2.0}) {
    for (const double y : {0.0, 0.5, 1.0}) {
      for (const double x : {0.0, 0.5, 1.0})
        places.push_back(corners[0] + x * (corners[1] - corners[0]) +
                         y * (corners[3] - corners[0]) +
                         Eigen::Vector3d(0.0, 0.0, z_up ? height : -height));
    }
  }
  return places;
}

std::string textOf(const NextMeasurement& next) {
  if (next.corners)
    return format("measure from corner %zu to corner %zu by tape", (*next.corners)[0] + 1,
                  (*next.corners)[1] + 1);
  return format("put the LED on a place you know, near (%.1f, %.1f, %.1f) m", next.place->x(),
                next.place->y(), next.place->z());
}

}  // namespace

std::optional<NextMeasurement> nextMeasurement(const square::Solution& found,
                                               const square::SquareLayout& layout,
                                               const std::vector<Eigen::Vector3d>& places,
                                               double pixel) {
  const geometry::Rig& rig = found.rig;
  const Eigen::MatrixXd& covariance = found.joint_covariance;
  const Eigen::Index parameters = covariance.rows();
  std::vector<Eigen::Vector3d> seen = places;
  const Eigen::MatrixXd by_rig = square::pointsByParameters(rig, &seen);
  Eigen::MatrixXd by_parameters = Eigen::MatrixXd::Zero(by_rig.rows(), parameters);
  by_parameters.leftCols(by_rig.cols()) = by_rig;
  const auto count = static_cast<double>(seen.size());
  const double now = (by_parameters * covariance).cwiseProduct(by_parameters).sum() / count;
  NextMeasurement best;
  double least = now;
  // By a Kalman update.
  const auto consider = [&](const NextMeasurement& next, const MeasurementModel& model) {
    const Eigen::MatrixXd gain = covariance * model.by_parameters.transpose();
    const Eigen::MatrixXd innovation = model.by_parameters * gain + model.covariance;
    const Eigen::MatrixXd moved = by_parameters * gain;
    const double squared = now - geometry::solveSymmetric(innovation, moved.transpose())
                                         .cwiseProduct(moved.transpose())
                                         .sum() /
                                     count;
    if (squared < least) {
      least = squared;
      best = next;
    }
  };
  NextMeasurement next;
  const square::Corners corners = layout.corners(found.z_up);
  for (std::size_t from = 0; from < corners.size(); ++from) {
    for (std::size_t to = from + 1; to < corners.size(); ++to) {
      next.corners = {from, to};
      consider(next, lengthBetween(corners, from, to, parameters));
    }
  }
  next.corners.reset();
  for (const Eigen::Vector3d& place : placesOver(corners, found.z_up)) {
    next.place = place;
    if (geometry::camerasSeeing(rig, place).size() >= 2)
      consider(next, pixelsOf(rig, place, pixel, parameters));
  }
  best.expected_error = std::sqrt(least);
  if (!(best.expected_error < (1.0 - kLeastGain) * std::sqrt(now)))
    return std::nullopt;
  best.text = textOf(best) + format(": expected RMS error %.1f -> %.1f mm", 1e3 * std::sqrt(now),
                                    1e3 * best.expected_error);
  return best;
}

}  // namespace wiimote_tracker::samples
