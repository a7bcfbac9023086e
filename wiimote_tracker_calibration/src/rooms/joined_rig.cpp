#include "rooms/joined_rig.h"

#include "samples/grade.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace wiimote_tracker::rooms {

using geometry::firstParameter;
using geometry::kParameters;
using geometry::kPosition;
using geometry::kRotation;
using geometry::kTimeOffset;

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
    if (same && same->camera.isOtherDevice(identity))
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

namespace {

/// Whether a shared camera's clock ran on from one calibration to the other. Its driver counts
/// epochs from 0 at each start, over the same link with the same offset.
bool hasRunOn(const geometry::RigCamera& earlier, const geometry::RigCamera& later) {
  return earlier.time_offset_rule != geometry::TimeOffsetRule::kOneEpoch ||
         later.time_offset_epoch == earlier.time_offset_epoch || later.time_offset_epoch == 0;
}

}  // namespace

ClockShift clockShift(const geometry::Rig& first, const geometry::Rig& second) {
  const Eigen::Index known = first.covariance.cols();
  ClockShift sum{0.0, Eigen::RowVectorXd::Zero(known + second.covariance.cols())};
  int count = 0;
  for (std::size_t i = 0; i < first.cameras.size(); ++i) {
    for (std::size_t j = 0; j < second.cameras.size(); ++j) {
      const geometry::RigCamera& a = first.cameras[i];
      const geometry::RigCamera& b = second.cameras[j];
      const double shift = a.time_offset - b.time_offset;
      if (a.camera.name != b.camera.name || !std::isfinite(shift) ||
          a.time_offset_rule != b.time_offset_rule ||
          a.time_offset_rule == geometry::TimeOffsetRule::kNone ||
          !(first.solved_at <= second.solved_at ? hasRunOn(a, b) : hasRunOn(b, a)))
        continue;
      ++count;
      sum.shift += shift;
      sum.by_errors[firstParameter(i) + kTimeOffset] += 1.0;
      sum.by_errors[known + firstParameter(j) + kTimeOffset] -= 1.0;
    }
  }
  if (count == 0)
    return {};
  return {sum.shift / count, sum.by_errors / count};
}

geometry::Rig joinedRig(const geometry::Rig& first,
                        const geometry::Rig& second,
                        const RigMotion& motion,
                        const ClockShift& clock) {
  const Eigen::Isometry3d& moved = motion.first_from_second;
  const Eigen::Index errors = motion.by_errors.cols();
  geometry::Rig rig = first;
  rig.remap.reset();
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
      rows.row(kTimeOffset).head(clock.by_errors.size()) += clock.by_errors;
    }
    camera.time_offset += clock.shift;
    Eigen::Isometry3d& pose = camera.camera.world_from_camera;
    pose = moved * pose;
    pose.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
    rig.cameras.push_back(camera);
  }
  by_errors.conservativeResize(firstParameter(rig.cameras.size()), Eigen::NoChange);
  rig.covariance = geometry::propagated(by_errors, motion.error_covariance);
  rig.method = first.method + " joined with " + second.method;
  rig.check();
  return rig;
}

std::string lostByJoining(const geometry::Rig& first, const geometry::Rig& second) {
  std::string clause;
  if (!second.zones.empty()) {
    std::vector<std::string> names;
    for (const geometry::Zone& zone : second.zones)
      names.push_back(zone.name);
    clause += "; the zones of the second rig (" + joined(names) +
              ") are left out: enter them in the world of the first";
  }
  if (first.remap || second.remap)
    clause += "; corrections of the volume are left out: measure known places and fit one again";
  return clause;
}

std::string joinedVerdict(const geometry::Rig& first,
                          const geometry::Rig& second,
                          const std::string& message) {
  const samples::Grade grade = std::max(
      {samples::Grade::kUsable, samples::gradeOf(first.verdict), samples::gradeOf(second.verdict)});
  return samples::nameOf(grade) + ": " + message + "; first: " + first.verdict +
         "; second: " + second.verdict;
}

}  // namespace wiimote_tracker::rooms
