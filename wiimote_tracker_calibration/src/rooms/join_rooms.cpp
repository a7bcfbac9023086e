#include "rooms/join_rooms.h"

#include "rooms/joined_rig.h"
#include "rooms/passage_fit.h"
#include "rooms/passages.h"
#include "rooms/room_accuracy.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <cmath>
#include <optional>
#include <string>

namespace wiimote_tracker::rooms {

namespace {

constexpr double kDegree = M_PI / 180.0;
// A world whose z axis is farther from the vertical by its cameras' accelerometers is not level:
// three standard deviations of an accelerometer, square::Uncertainty::gravity [rad].
constexpr double kSteepest = 9.0 * kDegree;
constexpr std::size_t kMostAdvised = 200;  // Passages.

/// The vertical axis of a world, z or -z, as the z axis of the result.
/// @throws Error: by the accelerometers it is not vertical.
Eigen::Isometry3d verticalOf(const geometry::Rig& rig, const std::string& which) {
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  for (const geometry::RigCamera& camera : rig.cameras) {
    if (camera.gravity)
      up += camera.camera.world_from_camera.linear() * camera.gravity->normalized();
  }
  Eigen::Isometry3d vertical = Eigen::Isometry3d::Identity();
  if (up.isZero())
    return vertical;
  const double slope = std::atan2(up.head<2>().norm(), std::abs(up.z()));
  if (slope > kSteepest)
    throw Error("by the accelerometers the world of the " + which +
                format(" rig slopes by %.0f degrees: say with --slope 180 that it is not level",
                       slope / kDegree));
  if (up.z() < 0.0)
    vertical.linear() = Eigen::DiagonalMatrix<double, 3>(1.0, -1.0, -1.0).toDenseMatrix();
  return vertical;
}

std::optional<Shared> sharedVertical(const geometry::Rig& first,
                                     const geometry::Rig& second,
                                     double slope) {
  if (std::isinf(slope))
    return std::nullopt;
  return Shared{verticalOf(first, "first"), verticalOf(second, "second"),
                Eigen::MatrixXd::Zero(2, first.covariance.cols()),
                Eigen::MatrixXd::Zero(2, second.covariance.cols()),
                Eigen::Vector3d::Constant(slope)};
}

/// What to do to know a point of the second room, and its rotation, as well as wanted.
std::string adviceFor(const PassageProblem& problem,
                      const PassageFit& fit,
                      const Eigen::Vector3d& point) {
  const std::string wanted = wantedAccuracy();
  const std::size_t passages = fit.used.size();
  for (std::size_t total = passages; total <= kMostAdvised; total += 1 + total / 10) {
    // n times as many passages have the weight of these with a scatter smaller by sqrt(n).
    const double share = static_cast<double>(total) / static_cast<double>(passages);
    const RigMotion motion =
        problem.fit(fit.used, fit.motion.first_from_second, fit.scatter / std::sqrt(share));
    if (!accuracyOf(motion, point).isAsWanted())
      continue;
    if (total == passages)
      return "that is as good as wanted (" + wanted + ")";
    return format("walk through the door about %zu more %s for ", total - passages,
                  total - passages == 1 ? "time" : "times") +
           wanted;
  }
  return "for " + wanted + " calibrate the rooms better: more passages are not enough";
}

std::string leftOut(std::size_t count, const char* why) {
  return count == 0 ? "" : format("; %zu left out: %s", count, why);
}

void checkNoSharedCamera(const geometry::Rig& first, const geometry::Rig& second) {
  for (const geometry::RigCamera& camera : second.cameras) {
    if (first.find(camera.camera.name))
      throw Error(camera.camera.name +
                  " is in both rigs: join them over it, by the service calibration/join");
  }
}

}  // namespace

JoinedRooms joinRooms(const geometry::Rig& first,
                      const geometry::Rig& second,
                      const std::vector<Path>& first_tracks,
                      const std::vector<Path>& second_tracks,
                      const JoinOptions& options) {
  checkRigs(first, second);
  checkNoSharedCamera(first, second);
  const Passages found = findPassages(first_tracks, second_tracks);
  std::string left_out =
      leftOut(found.crowded, "several LEDs at the same time") +
      leftOut(found.crooked, "not straight") +
      leftOut(found.unhidden, "both rooms saw an LED at that time (the same one?)");
  std::vector<SharedPlaces> places;
  for (const Passage& passage : found.passages) {
    if (const auto shared = sharedPlaces(first, second, passage, options.slowing))
      places.push_back(*shared);
  }
  left_out += leftOut(found.passages.size() - places.size(), "not in view of two cameras");
  if (places.empty())
    throw Error(format("no passage from one room to the other was found (LED hidden for at most "
                       "%.0f s, straight, faster than %.1f m/s, seen for %.1f s on either side)",
                       kLongestHidden, kSlowest, kShortestPart) +
                left_out);
  const PassageProblem problem(first, second, places, sharedVertical(first, second, options.slope));
  const PassageFit fit = fitPassages(problem);
  left_out += leftOut(places.size() - fit.used.size(), "contradicts the others (another LED?)");

  JoinedRooms result;
  result.first_from_second = fit.motion.first_from_second;
  result.passages = fit.used.size();
  const Eigen::Index known = first.covariance.cols() + second.covariance.cols();
  const Eigen::Vector3d middle = middleOfSecond(first, second);
  const RoomAccuracy accuracy = accuracyOf(fit.motion, middle);
  result.position_stddev = accuracy.position;
  result.rotation_stddev = accuracy.rotation;
  // Stamps of both rooms are of one clock, so the offsets of the second rig stay as they are.
  result.rig = joinedRig(first, second, fit.motion, {0.0, Eigen::RowVectorXd::Zero(known)});
  result.message =
      format("%zu cameras joined to the %zu of the first rig by %zu %s through the door%s; ",
             second.cameras.size(), first.cameras.size(), result.passages,
             result.passages == 1 ? "passage" : "passages", left_out.c_str()) +
      describe(accuracy) + "; " + adviceFor(problem, fit, middle) + lostByJoining(first, second);
  result.rig.verdict = joinedVerdict(first, second, result.message);
  return result;
}

}  // namespace wiimote_tracker::rooms
