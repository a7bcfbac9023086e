#include "continuous/adjustment.h"

#include <wiimote_tracker_msgs/median.h>
#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>

#include <optional>
#include <vector>

namespace wiimote_tracker::continuous {

namespace {

// Error of the stamps that changes slowly [s].
constexpr double kOffsetStddev = 0.0001;
// How far a known time offset may have changed against the others': clocks wander, and a driver
// that was started again may use another link [s].
constexpr double kWander = 0.001;
// Prior of the time offset in a new epoch, around 0 [s]. As wide as the benchmark draws it: unlike
// capture::kUnknownOffset it is estimated.
constexpr double kNewOffsetStddev = 0.02;

/// Of a camera's time offset, in the rig's covariance.
Eigen::Index parameterOf(std::size_t camera) {
  return geometry::firstParameter(camera) + geometry::kTimeOffset;
}

/// Shifts all time offsets so that those that were known have not changed, in the median.
void keepMedian(const geometry::Rig& before,
                const KeyframeSource& source,
                geometry::Rig* adjusted) {
  std::vector<double> changes;
  for (std::size_t i = 0; i < before.cameras.size(); ++i) {
    const auto epoch = source.epoch(i);
    const auto known = epoch ? before.cameras[i].timeOffsetIn(*epoch) : std::nullopt;
    if (known)
      changes.push_back(adjusted->cameras[i].time_offset - *known);
  }
  if (changes.empty())
    return;
  const double change = medianOf(&changes);
  for (std::size_t i = 0; i < before.cameras.size(); ++i) {
    if (source.epoch(i))
      adjusted->cameras[i].time_offset -= change;
  }
}

/// The covariance with that of the clocks against their mean.
Eigen::MatrixXd withoutCommonClock(const KeyframeSource& source,
                                   const Eigen::MatrixXd& covariance) {
  Eigen::VectorXd common = Eigen::VectorXd::Zero(covariance.rows());
  for (std::size_t i = 0; geometry::firstParameter(i) < covariance.rows(); ++i) {
    if (source.epoch(i))
      common[parameterOf(i)] = 1.0;
  }
  const Eigen::MatrixXd others = Eigen::MatrixXd::Identity(common.size(), common.size()) -
                                 common * common.transpose() / common.sum();
  return geometry::propagated(others, covariance);
}

}  // namespace

geometry::Rig withClockPrior(geometry::Rig rig, const KeyframeSource& source) {
  Eigen::MatrixXd& covariance = rig.covariance;
  std::vector<Eigen::Index> clocks;  // That are known.
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    geometry::RigCamera& camera = rig.cameras[i];
    const Eigen::Index clock = parameterOf(i);
    const auto epoch = source.epoch(i);
    const bool known = camera.timeOffsetIn(epoch.value_or(camera.time_offset_epoch)).has_value();
    if (known) {
      clocks.push_back(clock);
    } else {
      camera.time_offset = 0.0;
      camera.time_offset_rule = geometry::TimeOffsetRule::kOneEpoch;
      camera.time_offset_epoch = epoch.value_or(0);
      covariance.row(clock).setZero();
      covariance.col(clock).setZero();
    }
    const double offset = known ? kOffsetStddev : kNewOffsetStddev;
    covariance(clock, clock) += offset * offset;
  }
  for (const Eigen::Index a : clocks) {
    covariance(a, a) += kWander * kWander;
    for (const Eigen::Index b : clocks)
      covariance(a, b) -= kWander * kWander / static_cast<double>(clocks.size());
  }
  return rig;
}

void holdTime(const geometry::Rig& before, const KeyframeSource& source, geometry::Rig* adjusted) {
  keepMedian(before, source, adjusted);
  adjusted->covariance = withoutCommonClock(source, adjusted->covariance);
  for (std::size_t i = 0; i < before.cameras.size(); ++i) {
    const Eigen::Index clock = parameterOf(i);
    adjusted->covariance(clock, clock) += kOffsetStddev * kOffsetStddev;
    if (before.cameras[i].time_offset_rule == geometry::TimeOffsetRule::kNone)
      copyClock(before, i, adjusted);
  }
}

void copyClock(const geometry::Rig& from, std::size_t camera, geometry::Rig* to) {
  const geometry::RigCamera& source = from.cameras[camera];
  to->cameras[camera].time_offset = source.time_offset;
  to->cameras[camera].time_offset_rule = source.time_offset_rule;
  to->cameras[camera].time_offset_epoch = source.time_offset_epoch;
  const Eigen::Index clock = parameterOf(camera);
  to->covariance.row(clock).setZero();
  to->covariance.col(clock).setZero();
  to->covariance(clock, clock) = from.covariance(clock, clock);
}

geometry::Rig withClocks(const geometry::Rig& adjusted, geometry::Rig rig, bool only_new) {
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    if (!only_new || rig.cameras[i].hasNewClock(adjusted.cameras[i].time_offset_epoch))
      copyClock(adjusted, i, &rig);
  }
  return rig;
}

}  // namespace wiimote_tracker::continuous
