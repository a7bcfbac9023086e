#include "session/join_rigs.h"

#include "rig_motion.h"
#include "square/usable_cameras.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/point_sensitivity.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::session {

namespace {

using geometry::firstParameter;
using geometry::kParameters;
using geometry::kPosition;
using geometry::kRotation;
using geometry::kTimeOffset;

// A larger angle between the gravity readings of a shared camera means that it was moved [rad].
constexpr double kTurned = 0.05;
// Minimum width of the places relative to their length: on a line the rotation is not determined.
constexpr double kThinnest = 0.05;

/// Offset of the second rig's clock from the first's, from shared cameras with known time offsets.
struct ClockShift {
  double shift = std::numeric_limits<double>::quiet_NaN();  ///< [s]; NaN: not known.
  Eigen::RowVectorXd by_errors;                             ///< As RigMotion::by_errors.
};

ClockShift clockShift(const geometry::Rig& first,
                      const geometry::Rig& second,
                      Eigen::Index error_count) {
  ClockShift sum{0.0, Eigen::RowVectorXd::Zero(error_count)};
  int count = 0;
  for (std::size_t i = 0; i < first.cameras.size(); ++i) {
    for (std::size_t j = 0; j < second.cameras.size(); ++j) {
      const geometry::RigCamera& a = first.cameras[i];
      const geometry::RigCamera& b = second.cameras[j];
      const double shift = a.time_offset - b.time_offset;
      if (a.camera.name != b.camera.name || !std::isfinite(shift) ||
          a.time_offset_rule != b.time_offset_rule ||
          a.time_offset_rule == geometry::TimeOffsetRule::kNone ||
          (a.time_offset_rule == geometry::TimeOffsetRule::kOneEpoch &&
           a.time_offset_epoch != b.time_offset_epoch))
        continue;
      ++count;
      sum.shift += shift;
      sum.by_errors[firstParameter(i) + kTimeOffset] += 1.0;
      sum.by_errors[first.covariance.cols() + firstParameter(j) + kTimeOffset] -= 1.0;
    }
  }
  if (count == 0)
    return {};
  return {sum.shift / count, sum.by_errors / count};
}

/// The first rig with the second's other cameras, moved into its world.
geometry::Rig joinedRig(const geometry::Rig& first,
                        const geometry::Rig& second,
                        const RigMotion& motion) {
  const Eigen::Isometry3d& moved = motion.first_from_second;
  const Eigen::Index errors = motion.by_errors.cols();
  const ClockShift clock = clockShift(first, second, errors);
  geometry::Rig rig = first;
  const Eigen::Index known = first.covariance.rows();
  // The result's errors by those of both rigs and of what they share.
  Eigen::MatrixXd by_errors = Eigen::MatrixXd::Zero(known + second.covariance.rows(), errors);
  by_errors.topLeftCorner(known, known).setIdentity();
  for (std::size_t j = 0; j < second.cameras.size(); ++j) {
    if (first.find(second.cameras[j].camera.name))
      continue;
    geometry::RigCamera camera = second.cameras[j];
    auto rows = by_errors.middleRows<kParameters>(firstParameter(rig.cameras.size()));
    const Eigen::Index column = known + firstParameter(j);
    rows.middleCols<kParameters>(column).setIdentity();
    rows.block<3, 3>(kRotation, column + kRotation) = moved.linear();
    rows.block<3, 3>(kPosition, column + kPosition) = moved.linear();
    rows.topRows<6>() += motion.by_errors;
    rows.middleRows<3>(kPosition) -= geometry::so3::skew(moved.linear() * camera.camera.center()) *
                                     motion.by_errors.topRows<3>();
    if (std::isnan(clock.shift)) {
      rows.row(kTimeOffset).setZero();
      camera.time_offset_rule = geometry::TimeOffsetRule::kNone;
    } else {
      rows.row(kTimeOffset) += clock.by_errors;
    }
    camera.time_offset += clock.shift;
    Eigen::Isometry3d& pose = camera.camera.world_from_camera;
    pose = moved * pose;
    pose.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
    rig.cameras.push_back(camera);
  }
  by_errors.conservativeResize(firstParameter(rig.cameras.size()), Eigen::NoChange);
  const Eigen::MatrixXd covariance = by_errors * motion.error_covariance * by_errors.transpose();
  rig.covariance = 0.5 * (covariance + covariance.transpose());
  return rig;
}

void checkRigs(const geometry::Rig& first, const geometry::Rig& second) {
  first.check();
  second.check();
  if (first.id() == second.id())
    throw Error("both are the same rig, " + first.id() + ": name the rig file of the other room");
  if (std::all_of(second.cameras.begin(), second.cameras.end(),
                  [&](const geometry::RigCamera& c) { return first.find(c.camera.name); }))
    throw Error(
        "all cameras of the second rig are in the first one already: there is nothing to join");
  for (const geometry::Rig* rig : {&first, &second}) {
    if (!geometry::hasCovariance(*rig))
      throw Error(std::string("the ") + (rig == &first ? "first" : "second") +
                  " rig does not say how certain its cameras are: calibrate it again");
  }
  if (first.ray_model != second.ray_model)
    throw Error(
        "the rigs build their rays by different models: calibrate both with the same ray_model");
  for (const geometry::RigCamera& camera : second.cameras) {
    const std::string& identity = camera.camera.identity;
    const geometry::RigCamera* same = first.find(camera.camera.name);
    if (same && !identity.empty() && !same->camera.identity.empty() &&
        identity != same->camera.identity)
      throw Error(camera.camera.name + " is another device in the second rig (" + identity +
                  ") than in the first (" + same->camera.identity +
                  "): give it another name, or calibrate again with the same device");
    for (const geometry::RigCamera& other : first.cameras) {
      if (!same && !identity.empty() && identity == other.camera.identity)
        throw Error("the device " + identity + " is called " + camera.camera.name +
                    " in the second rig, but " + other.camera.name +
                    " in the first: give it one name and calibrate again");
    }
  }
}

void checkGravity(const geometry::RigCamera& first, const geometry::RigCamera& second) {
  if (!first.gravity || !second.gravity)
    return;
  const double angle =
      std::atan2(first.gravity->cross(*second.gravity).norm(), first.gravity->dot(*second.gravity));
  if (angle > kTurned)
    throw Error(first.camera.name + " was turned by " +
                format("%.1f degrees", angle * 180.0 / M_PI) +
                " between both calibrations, by its accelerometer: calibrate one of "
                "the rooms again");
}

JoinedRigs finish(const geometry::Rig& first,
                  const geometry::Rig& second,
                  const RigMotion& motion,
                  const std::string& over) {
  JoinedRigs result;
  result.first_from_second = motion.first_from_second;
  result.chi_squared = motion.chi_squared;
  result.degrees_of_freedom = motion.degrees_of_freedom;
  result.rig = joinedRig(first, second, motion);
  const std::size_t added = result.rig.cameras.size() - first.cameras.size();
  result.message = format("%zu %s joined to the %zu of the first rig over ", added,
                          added == 1 ? "camera" : "cameras", first.cameras.size()) +
                   over;
  if (motion.degrees_of_freedom > 0)
    result.message +=
        format("; the rigs disagree %.1f times as much as expected from their uncertainties",
               std::sqrt(motion.chi_squared / motion.degrees_of_freedom));
  else
    result.message += "; a second shared camera would check that it did not move in between";
  result.rig.method = first.method + " joined with " + second.method;
  result.rig.verdict = result.message + "; first: " + first.verdict + "; second: " + second.verdict;
  result.rig.check();
  return result;
}

/// Derivative of the pose of a camera by all parameters of its rig.
Eigen::MatrixXd poseByParameters(const geometry::Rig& rig, std::size_t camera) {
  Eigen::MatrixXd derivative = Eigen::MatrixXd::Zero(6, rig.covariance.cols());
  derivative.middleCols<6>(firstParameter(camera)).setIdentity();
  return derivative;
}

/// @throws Error: too few places, values out of range, or all on one line.
void checkPlaces(const std::vector<CommonPlace>& places) {
  if (places.size() < 3)
    throw Error(std::to_string(places.size()) +
                " common places do not determine the pose between the rigs: measure three or "
                "more, not on one line");
  Eigen::Matrix3Xd points(3, places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const CommonPlace& place = places[i];
    if (!place.in_first.allFinite() || !place.in_second.allFinite() ||
        !(std::isfinite(place.stddev) && place.stddev > 0.0))
      throw Error("place " + std::to_string(i + 1) +
                  " is not finite, or its standard deviation not above 0: correct it");
    points.col(static_cast<Eigen::Index>(i)) = place.in_second;
  }
  const Eigen::Matrix3Xd centered = points.colwise() - points.rowwise().mean();
  const Eigen::Vector3d extent =
      Eigen::JacobiSVD<Eigen::MatrixXd>(centered.transpose()).singularValues();
  if (!(extent[1] > kThinnest * extent[0]))
    throw Error("the common places are on one line: measure one beside it, too");
}

/// The motion that brings the places of the second world nearest to those of the first.
Eigen::Isometry3d startOver(const std::vector<CommonPlace>& places) {
  Eigen::Matrix3Xd from(3, places.size());
  Eigen::Matrix3Xd to(3, places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    from.col(static_cast<Eigen::Index>(i)) = places[i].in_second;
    to.col(static_cast<Eigen::Index>(i)) = places[i].in_first;
  }
  return Eigen::Isometry3d(Eigen::umeyama(from, to, false));
}

}  // namespace

JoinedRigs joinRigs(const geometry::Rig& first, const geometry::Rig& second) {
  checkRigs(first, second);
  std::vector<Shared> shared;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < first.cameras.size(); ++i) {
    for (std::size_t j = 0; j < second.cameras.size(); ++j) {
      if (first.cameras[i].camera.name != second.cameras[j].camera.name)
        continue;
      checkGravity(first.cameras[i], second.cameras[j]);
      shared.push_back({first.cameras[i].camera.world_from_camera,
                        second.cameras[j].camera.world_from_camera, poseByParameters(first, i),
                        poseByParameters(second, j)});
      names.push_back(first.cameras[i].camera.name);
    }
  }
  if (names.empty())
    throw Error(
        "the rigs share no camera: calibrate the second room together with a camera of the first "
        "that stays where it is, or measure three known places or more of the first world with the "
        "second rig");
  const Eigen::Isometry3d start = shared[0].in_first * shared[0].in_second.inverse();
  const RigMotion motion = fitMotion(first, second, shared, start);
  if (motion.contradicts()) {
    if (names.size() == 2)
      throw Error(names[0] + " and " + names[1] +
                  " do not stand to each other in the second rig as in the first: one of "
                  "them was moved in between, or calibrated badly; calibrate one of the "
                  "rooms anew");
    throw Error(names[oddOneOut(first, second, shared, start)] +
                " does not stand to the other shared cameras in the second rig as in the "
                "first: it was moved in between, or was calibrated badly; calibrate one of "
                "the rooms again");
  }
  JoinedRigs result = finish(first, second, motion, square::listOf(names));
  result.shared = names;
  return result;
}

JoinedRigs joinRigs(const geometry::Rig& first,
                    const geometry::Rig& second,
                    const std::vector<CommonPlace>& places) {
  checkRigs(first, second);
  checkPlaces(places);
  std::vector<Shared> shared;
  for (const CommonPlace& place : places) {
    const auto derivative = geometry::pointByParameters(
        second, place.in_second, geometry::camerasSeeing(second, place.in_second));
    if (!derivative)
      throw Error("no two cameras of the second rig look at place " +
                  std::to_string(shared.size() + 1) + ": measure places that they see");
    shared.push_back({Eigen::Isometry3d(Eigen::Translation3d(place.in_first)),
                      Eigen::Isometry3d(Eigen::Translation3d(place.in_second)),
                      Eigen::MatrixXd::Zero(3, first.covariance.cols()), *derivative,
                      place.stddev});
  }
  const Eigen::Isometry3d start = startOver(places);
  const RigMotion motion = fitMotion(first, second, shared, start);
  if (motion.contradicts()) {
    if (places.size() == 3)
      throw Error(
          "the three common places do not lie to one another in the second rig as in the first: "
          "measure them again, and a fourth");
    throw Error("place " + std::to_string(oddOneOut(first, second, shared, start) + 1) +
                " does not lie to the other common places in the second rig as in the "
                "first: measure it again");
  }
  return finish(first, second, motion, std::to_string(places.size()) + " common places");
}

}  // namespace wiimote_tracker::session
