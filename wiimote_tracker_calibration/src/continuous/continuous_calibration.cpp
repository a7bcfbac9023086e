#include "continuous/continuous_calibration.h"

#include "continuous/adjustment.h"
#include "continuous/knocked_cameras.h"
#include "health/drift_watch.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace wiimote_tracker::continuous {

namespace {

// A camera was knocked if it turned by so many standard deviations of its drift, or by so much,
// farther than a camera drifts in days [rad].
constexpr double kKnockedDeviations = 10.0;
constexpr double kKnockedTurn = 0.007;

/// Whether a camera has no time offset: it was solved from a square only.
bool lacksClock(const geometry::Rig& rig) {
  return std::any_of(rig.cameras.begin(), rig.cameras.end(), [](const geometry::RigCamera& camera) {
    return camera.time_offset_rule == geometry::TimeOffsetRule::kNone;
  });
}

/// The one camera that turned by more than a limit [rad], and twice as far as any other.
std::optional<std::size_t> turnedAlone(const geometry::Rig& before,
                                       const geometry::Rig& now,
                                       double limit) {
  std::vector<double> turns;
  for (std::size_t i = 0; i < now.cameras.size(); ++i)
    turns.push_back(turnOf(before.cameras[i], now.cameras[i]));
  const auto most = std::max_element(turns.begin(), turns.end());
  const bool is_alone = std::count_if(turns.begin(), turns.end(),
                                      [&](double turn) { return 2.0 * turn > *most; }) == 1;
  if (!is_alone || *most < limit)
    return std::nullopt;
  return static_cast<std::size_t>(most - turns.begin());
}

/// The camera that contradicts the others, if there is one alone.
std::optional<std::size_t> offAlone(const geometry::Rig& rig,
                                    const std::vector<capture::Image>& images) {
  const health::Drifts drifts = health::driftsOf(rig, images);
  const auto isOff = [](const auto& drift) { return drift && drift->ratio >= 1.0; };
  if (std::count_if(drifts.begin(), drifts.end(), isOff) != 1)
    return std::nullopt;
  const auto found = std::find_if(drifts.begin(), drifts.end(), isOff);
  return static_cast<std::size_t>(found - drifts.begin());
}

}  // namespace

ContinuousCalibration::ContinuousCalibration(const geometry::Rig& rig, const Options& options)
    : rig_(rig), options_(options), suspects_(rig, options.suspects), motion_(options.adjustment) {}

std::optional<Proposal> ContinuousCalibration::add(const capture::Image& image) {
  const geometry::RigCamera* camera = rig_.find(image.camera);
  if (camera == nullptr || camera->camera.isOtherDevice(image.identity))
    return std::nullopt;
  // Its driver was started again, over the same link, and counts from 0: what it counts from here
  // on are reconnections.
  if (camera->time_offset_rule == geometry::TimeOffsetRule::kOneEpoch &&
      image.clock_epoch < camera->time_offset_epoch) {
    geometry::Rig rig = rig_;
    rig.cameras[static_cast<std::size_t>(camera - rig_.cameras.data())].time_offset_epoch =
        image.clock_epoch;
    *this = ContinuousCalibration(rig, options_);
  }
  const auto evidence = suspects_.add(image);
  if (!suspects_.severalAreSuspect())
    contradiction_.clear();
  const bool is_enough = motion_.add(image);
  if (evidence) {
    if (auto proposal = solvedSuspect(*evidence))
      return proposal;
  }
  if (!is_enough)
    return std::nullopt;
  from_motion_ = solvedFromMotion();
  return from_motion_;
}

bool ContinuousCalibration::isCurrent(const Proposal& proposal) const {
  if (suspects_.areSuspect(proposal.cameras))
    return true;
  if (!from_motion_ || proposal.cause != Cause::kKnock)
    return from_motion_.has_value();
  return from_motion_->cause == Cause::kKnock && from_motion_->cameras == proposal.cameras;
}

void ContinuousCalibration::addAcceleration(const std::string& camera,
                                            const Eigen::Vector3d& specific_force) {
  suspects_.addAcceleration(camera, specific_force);
}

std::optional<Proposal> ContinuousCalibration::solvedSuspect(const Evidence& evidence) {
  // A camera that only reconnected keeps its place.
  if (evidence.new_clock) {
    if (auto proposal = adjustedTogether(evidence.images))
      return proposal;
  }
  return solvedAgainstOthers(evidence);
}

std::optional<Proposal> ContinuousCalibration::solvedFromMotion() {
  const MotionImages images = motion_.images();
  const auto adjusted = adjustedRig(images);
  auto proposal = adjusted ? proposeAdjustment(rig_, *adjusted, images.to_check) : std::nullopt;
  if (adjusted && !proposal)
    proposal = adjustedWithoutKnocked(*adjusted, images);
  if (proposal && proposal->cause == Cause::kDrift) {
    if (auto knock = knockFoundBy(*proposal, images))
      return knock;
  }
  return proposal;
}

std::optional<Proposal> ContinuousCalibration::solvedAgainstOthers(const Evidence& evidence) {
  Cameras knocked;
  if (evidence.camera) {
    knocked = {*evidence.camera};
  } else {
    const std::vector<Cameras> pairs = pairsToSolve(rig_, evidence);
    const std::string contradiction = contradictionOf(rig_, pairs);
    if (!contradiction.empty())
      contradiction_ = contradiction;
    if (pairs.size() != 1)
      return std::nullopt;
    contradiction_.clear();
    knocked = pairs.front();
  }
  const auto solved = solveAgainstOthers(rig_, knocked, evidence, options_.recalibrate);
  if (!solved)
    return std::nullopt;
  std::vector<std::string> names;
  for (const std::size_t camera : knocked)
    names.push_back(rig_.cameras[camera].camera.name);
  const Cause cause = evidence.new_clock ? Cause::kReconnect : Cause::kKnock;
  return dated({cause, names, solved->rig, 0.0, solved->message, {}}, rig_,
               evidence.images.to_check);
}

std::optional<Proposal> ContinuousCalibration::knockFoundBy(const Proposal& drift,
                                                            const MotionImages& images) {
  const double limit =
      std::min(kKnockedDeviations * driftUntil(images.to_check.back().stamp, rig_), kKnockedTurn);
  const auto camera = turnedAlone(rig_, drift.rig, limit);
  if (!camera)
    return std::nullopt;
  Evidence evidence;
  evidence.camera = camera;
  evidence.has_turned = true;
  evidence.images = images;
  evidence.gravity.resize(rig_.cameras.size());
  return solvedAgainstOthers(evidence);
}

std::optional<geometry::Rig> ContinuousCalibration::adjustedRig(const MotionImages& images) const {
  // Four corners tell little of the lenses: other poses explain the images above the square better,
  // though no camera has turned, and do not make points more accurate.
  return lacksClock(rig_) ? std::nullopt : adjustRig(rig_, images.to_solve);
}

std::optional<Proposal> ContinuousCalibration::adjustedTogether(const MotionImages& images) const {
  const auto adjusted = adjustedRig(images);
  return adjusted ? proposeAdjustment(rig_, *adjusted, images.to_check) : std::nullopt;
}

std::optional<Proposal> ContinuousCalibration::adjustedWithoutKnocked(
    const geometry::Rig& adjusted,
    const MotionImages& images) const {
  const std::vector<std::string> new_clocks = newClocks();
  if (new_clocks.empty())
    return std::nullopt;
  const auto knocked = offAlone(withClocks(adjusted, rig_), images.to_check);
  if (!knocked || new_clocks == std::vector<std::string>{rig_.cameras[*knocked].camera.name})
    return std::nullopt;  // no other camera needs a clock
  return adjustedTogether(
      {without(rig_, {*knocked}, images.to_solve), without(rig_, {*knocked}, images.to_check)});
}

}  // namespace wiimote_tracker::continuous
