#include "rooms/join_rigs.h"

#include "rooms/joined_rig.h"
#include "rooms/room_accuracy.h"
#include "square/usable_cameras.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/point_sensitivity.h>

#include <Eigen/Geometry>

#include <cmath>

namespace wiimote_tracker::rooms {

namespace {

using geometry::firstParameter;

// A larger angle between the gravity readings of a shared camera means that it was moved [rad].
constexpr double kTurned = 0.05;

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

/// @param over what they share. @param checked whether that tells what moved in between.
/// @param remedy what would determine the motion better.
JoinedRigs finish(const geometry::Rig& first,
                  const geometry::Rig& second,
                  const RigMotion& motion,
                  const std::string& over,
                  bool checked,
                  const std::string& remedy) {
  JoinedRigs result{joinedRig(first, second, motion, clockShift(first, second)), motion, ""};
  const RoomAccuracy accuracy = accuracyOf(motion, middleOfSecond(first, second));
  const std::size_t added = result.rig.cameras.size() - first.cameras.size();
  result.message = format("%zu %s joined to the %zu of the first rig over ", added,
                          added == 1 ? "camera" : "cameras", first.cameras.size()) +
                   over + "; " + describe(accuracy);
  if (!accuracy.isAsWanted())
    result.message +=
        "; for " + wantedAccuracy() + " " + remedy + ", or calibrate both rooms by a longer wave";
  if (checked)
    result.message +=
        format("; the rigs disagree %.1f times as much as expected from their uncertainties",
               std::sqrt(motion.chi_squared / motion.degrees_of_freedom));
  else
    result.message += "; a second shared camera would check that it did not move in between";
  result.message += lostByJoining(first, second);
  result.rig.verdict = joinedVerdict(first, second, result.message);
  return result;
}

/// A camera of both rigs, which has one pose and one lens. The lens counts since its errors turn
/// the camera in both rigs: what both have in common does not turn the second room.
Shared sharedCamera(const geometry::Rig& first,
                    std::size_t in_first,
                    const geometry::Rig& second,
                    std::size_t in_second) {
  const geometry::Camera& a = first.cameras[in_first].camera;
  const geometry::Camera& b = second.cameras[in_second].camera;
  const auto by_parameters = [](const geometry::Rig& rig, std::size_t camera) {
    Eigen::MatrixXd derivative = Eigen::MatrixXd::Zero(10, rig.covariance.cols());
    derivative.middleCols<10>(firstParameter(camera)).setIdentity();
    return derivative;
  };
  Shared shared{a.world_from_camera, b.world_from_camera, by_parameters(first, in_first),
                by_parameters(second, in_second)};
  shared.lens_difference << b.intrinsics.fx - a.intrinsics.fx, b.intrinsics.fy - a.intrinsics.fy,
      b.intrinsics.cx - a.intrinsics.cx, b.intrinsics.cy - a.intrinsics.cy;
  return shared;
}

/// @throws Error: too few places, or all on one line.
void checkPlaces(const std::vector<remap::KnownPoint>& places) {
  if (places.size() < 3)
    throw Error(counted(places.size(), "common place") +
                " cannot determine the pose between the rigs: measure three or "
                "more, not on one line");
  std::vector<Eigen::Vector3d> points;
  points.reserve(places.size());
  for (const remap::KnownPoint& place : places)
    points.push_back(place.measured);
  const Eigen::Vector3d extent = geometry::spreadOf(points);
  if (!(extent[1] > kThinnest * extent[0]))
    throw Error("the common places are on one line: measure one beside it, too");
}

JoinedRigs joinOver(const std::vector<remap::KnownPoint>& places,
                    double stddev,
                    const geometry::Rig& first,
                    const geometry::Rig& second) {
  checkPlaces(places);
  std::vector<Eigen::Vector3d> in_first;
  std::vector<Eigen::Vector3d> in_second;
  std::vector<Shared> shared;
  for (const remap::KnownPoint& place : places) {
    const auto derivative = geometry::pointByParameters(
        second, place.measured, geometry::camerasSeeing(second, place.measured));
    if (!derivative)
      throw Error("no two cameras of the second rig look at place " +
                  std::to_string(shared.size() + 1) + ": measure places that they see");
    shared.push_back({Eigen::Isometry3d(Eigen::Translation3d(place.known)),
                      Eigen::Isometry3d(Eigen::Translation3d(place.measured)),
                      Eigen::MatrixXd::Zero(3, first.covariance.cols()), *derivative,
                      Eigen::Vector3d::Constant(stddev)});
    in_first.push_back(place.known);
    in_second.push_back(place.measured);
  }
  const Eigen::Isometry3d start = geometry::rigidAlignment(in_first, in_second);
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
  return finish(first, second, motion, std::to_string(places.size()) + " common places", true,
                "measure more places, farther apart");
}

}  // namespace

JoinedRigs joinRigs(const geometry::Rig& first,
                    const geometry::Rig& second,
                    const std::vector<remap::KnownPoint>& places,
                    double stddev) {
  checkRigs(first, second);
  std::vector<Shared> shared;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < first.cameras.size(); ++i) {
    for (std::size_t j = 0; j < second.cameras.size(); ++j) {
      if (first.cameras[i].camera.name != second.cameras[j].camera.name)
        continue;
      checkGravity(first.cameras[i], second.cameras[j]);
      shared.push_back(sharedCamera(first, i, second, j));
      names.push_back(first.cameras[i].camera.name);
    }
  }
  if (names.empty() && !places.empty())
    return joinOver(places, stddev, first, second);
  if (names.empty())
    throw Error(
        "the rigs share no camera: calibrate the second room together with a camera of the first "
        "that stays where it is, or measure three known places or more of the first world with the "
        "second rig");
  const Eigen::Isometry3d start = shared[0].in_first * shared[0].in_second.inverse();
  const RigMotion motion = fitMotion(first, second, shared, start);
  if (motion.contradicts()) {
    if (names.size() == 1)
      throw Error("the lens of " + names[0] +
                  " in the second rig is not that in the first, by the uncertainties of both: "
                  "calibrate one of the rooms again");
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
  return finish(first, second, motion, square::listOf(names), names.size() > 1,
                "let another camera see both rooms");
}

}  // namespace wiimote_tracker::rooms
