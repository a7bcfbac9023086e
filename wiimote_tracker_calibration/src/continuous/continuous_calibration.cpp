#include "continuous/continuous_calibration.h"

#include "continuous/adjust_rig.h"
#include "continuous/drifts.h"
#include "continuous/knocked_cameras.h"

#include <wiimote_tracker_msgs/text.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

namespace wiimote_tracker::continuous {

namespace {

constexpr double kDegrees = 180.0 / M_PI;  // in one radian
// Least gain of a proposal about drift [px]. What is not applied is forgotten: the higher this is,
// the more of the world is lost with each knock. The lower, the more errors of lenses look like
// drift.
constexpr double kWorthProposing = 0.05;
// Least gain of other poses over the same poses with the adjusted clocks [px]; below, cameras keep
// their poses.
constexpr double kWorthTurning = 0.05;
// A camera was knocked if it turned by so many standard deviations of its drift, or by so much,
// farther than a camera drifts in days [rad].
constexpr double kKnockedDeviations = 10.0;
constexpr double kKnockedTurn = 0.007;
// The clock of a camera that did not reconnect has changed if its time offset did by more [s].
constexpr double kOtherOffset = 0.001;

/// Whether a camera has no time offset: it was solved from a square only.
bool lacksClock(const geometry::Rig& rig) {
  return std::any_of(rig.cameras.begin(), rig.cameras.end(), [](const geometry::RigCamera& camera) {
    return camera.time_offset_rule == geometry::TimeOffsetRule::kNone;
  });
}

/// Replaces what an earlier change has added to the verdict.
std::string verdictWith(const std::string& verdict, const std::string& change) {
  const std::string kSince = "; since then ";
  return verdict.substr(0, verdict.find(kSince)) + kSince + change;
}

Proposal proposalOf(Cause cause,
                    const std::vector<std::string>& cameras,
                    const geometry::Rig& before,
                    const geometry::Rig& rig,
                    const std::string& message,
                    const std::vector<capture::Image>& checked) {
  Proposal proposal{cause, cameras, rig, 0.0, message, {}};
  proposal.rig.solved_at = checked.back().stamp;
  proposal.rig.verdict = verdictWith(before.verdict, message);
  return proposal;
}

double turnOf(const geometry::RigCamera& a, const geometry::RigCamera& b) {
  return Eigen::AngleAxisd(a.camera.world_from_camera.linear().transpose() *
                           b.camera.world_from_camera.linear())
      .angle();
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

/// Whether no camera has reconnected since the rig was solved.
bool clocksHold(const geometry::Rig& rig, const std::vector<capture::Image>& images) {
  return std::all_of(images.begin(), images.end(), [&](const capture::Image& image) {
    const geometry::RigCamera* const camera = rig.find(image.camera);
    return camera == nullptr || !camera->hasNewClock(image.clock_epoch);
  });
}

/// The rig before an adjustment with the new clocks that it found, or with all clocks.
geometry::Rig withClocks(geometry::Rig before, const geometry::Rig& adjusted, bool all) {
  for (std::size_t i = 0; i < before.cameras.size(); ++i) {
    if (all || before.cameras[i].hasNewClock(adjusted.cameras[i].time_offset_epoch))
      copyClock(adjusted, i, &before);
  }
  return before;
}

bool newClocksAreJudged(const geometry::Rig& before,
                        const geometry::Rig& now,
                        const Drifts& drifts) {
  for (std::size_t i = 0; i < now.cameras.size(); ++i) {
    if (before.cameras[i].hasNewClock(now.cameras[i].time_offset_epoch) && !drifts[i])
      return false;
  }
  return true;
}

bool hasOtherOffset(const geometry::RigCamera& before, const geometry::RigCamera& now) {
  return std::abs(now.time_offset - before.time_offset) > kOtherOffset;
}

/// The camera that changed most: by a new clock, else by another time offset, else by its turn.
std::size_t mostChanged(const geometry::Rig& before, const geometry::Rig& now) {
  const auto change = [&](std::size_t i) {
    const geometry::RigCamera& was = before.cameras[i];
    const geometry::RigCamera& camera = now.cameras[i];
    return std::make_tuple(was.hasNewClock(camera.time_offset_epoch), hasOtherOffset(was, camera),
                           turnOf(was, camera));
  };
  std::size_t most = 0;
  for (std::size_t i = 1; i < now.cameras.size(); ++i) {
    if (change(i) > change(most))
      most = i;
  }
  return most;
}

/// How much of the squared misfit a rig explains [px^2].
double gainOf(const Fit& before, const Fit& after) {
  return before.misfit * before.misfit - after.misfit * after.misfit;
}

/// What an adjustment has changed: "camera_1 turned by 0.03 degrees, camera_2 ...".
std::string changesText(const geometry::Rig& before, const geometry::Rig& now) {
  std::vector<std::string> changes;
  for (std::size_t i = 0; i < now.cameras.size(); ++i) {
    const geometry::RigCamera& was = before.cameras[i];
    const geometry::RigCamera& camera = now.cameras[i];
    std::vector<std::string> own;
    if (camera.camera.world_from_camera.matrix() != was.camera.world_from_camera.matrix())
      own.push_back(format(" turned by %.2f degrees", turnOf(was, camera) * kDegrees));
    if (was.hasNewClock(camera.time_offset_epoch))
      own.push_back(format(" has a new clock, %.1f ms off", 1000.0 * camera.time_offset));
    else if (hasOtherOffset(was, camera))
      own.push_back(format(" has a clock that changed by %.1f ms",
                           1000.0 * (camera.time_offset - was.time_offset)));
    if (!own.empty())
      changes.push_back(camera.camera.name + joined(own, " and"));
  }
  return joined(changes, ", ");
}

}  // namespace

ContinuousCalibration::ContinuousCalibration(const geometry::Rig& rig, const Options& options)
    : rig_(rig), options_(options), knock_(rig, options.knock), motion_(options.drift) {}

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
  const auto suspect = knock_.add(image);
  if (!knock_.severalAreSuspect())
    contradiction_.clear();
  const bool has_moved = motion_.add(image);
  std::optional<Proposal> proposal;
  // A camera that only reconnected keeps its place.
  if (suspect && suspect->new_clock)
    proposal = adjustedTogether(suspect->images);
  if (suspect && !proposal)
    proposal = solvedAgainstOthers(*suspect);
  if (has_moved && !proposal) {
    proposal = adjustedTogether(motion_.images());
    if (!proposal && !newClocks().empty())
      proposal = adjustedWithoutKnocked(motion_.images());
    has_drifted_ = proposal.has_value();
    turned_.clear();
    if (proposal && proposal->cause == Cause::kDrift) {
      if (auto knock = knockFoundBy(*proposal, motion_.images())) {
        turned_ = knock->cameras;
        proposal = std::move(knock);
      }
    }
  }
  return proposal;
}

void ContinuousCalibration::addAcceleration(const std::string& camera,
                                            const Eigen::Vector3d& specific_force) {
  knock_.addAcceleration(camera, specific_force);
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
  return proposalOf(evidence.new_clock ? Cause::kReconnect : Cause::kKnock, names, rig_,
                    solved->rig, solved->message, evidence.images.to_check);
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

std::optional<Proposal> ContinuousCalibration::adjustedTogether(const MotionImages& images) const {
  // Four corners tell little of the lenses: other poses explain the images above the square better,
  // though no camera has turned, and do not make points more accurate.
  if (lacksClock(rig_))
    return std::nullopt;
  auto rig = adjustRig(rig_, images.to_solve);
  // Another light carried along can fit, with all cameras turned farther than they drift.
  if (!rig || !clocksHold(*rig, images.to_check) || !isWithinDrift(rig_, *rig))
    return std::nullopt;
  const auto before = fitOf(withClocks(rig_, *rig, false), images.to_check);
  const geometry::Rig with_clocks = withClocks(rig_, *rig, true);
  const auto clocks_only = fitOf(with_clocks, images.to_check);
  auto after = fitOf(*rig, images.to_check);
  if (!before || !clocks_only || !after)
    return std::nullopt;
  // Cameras turn if that explains what their clocks do not.
  const bool keeps_poses = gainOf(*clocks_only, *after) < kWorthTurning * kWorthTurning;
  if (keeps_poses) {
    rig = with_clocks;
    after = clocks_only;
  }
  const double gain = gainOf(*before, *after);
  const Drifts drifts = driftsOf(*rig, images.to_check);
  if (!allFit(drifts))
    return std::nullopt;
  if (!newClocksAreJudged(rig_, *rig, drifts))
    return std::nullopt;
  const std::size_t most = mostChanged(rig_, *rig);
  const bool reconnected = rig_.cameras[most].hasNewClock(rig->cameras[most].time_offset_epoch);
  const bool has_drifted = gain >= kWorthProposing * kWorthProposing &&
                           (!keeps_poses || hasOtherOffset(rig_.cameras[most], rig->cameras[most]));
  if (!reconnected && !has_drifted)
    return std::nullopt;
  const std::string message = changesText(rig_, *rig) +
                              (reconnected ? "" : ": drift, or errors of the calibration") +
                              format(". Corrected, the images agree to %.2f px", after->misfit) +
                              (reconnected ? "" : format(" (now %.2f px)", before->misfit));
  Proposal proposal =
      proposalOf(reconnected ? Cause::kReconnect : Cause::kDrift, {rig_.cameras[most].camera.name},
                 rig_, *rig, message, images.to_check);
  proposal.places = after->places;
  if (proposal.cause == Cause::kDrift)
    proposal.gain = std::sqrt(gain);
  if (keeps_poses)
    proposal.rig.solved_at = rig_.solved_at;
  return proposal;
}

std::optional<Proposal> ContinuousCalibration::adjustedWithoutKnocked(
    const MotionImages& images) const {
  const auto rig = adjustRig(rig_, images.to_solve);
  if (!rig)
    return std::nullopt;
  const Drifts drifts = driftsOf(withClocks(rig_, *rig, true), images.to_check);
  const auto isOff = [](const auto& drift) { return drift && drift->ratio >= 1.0; };
  if (std::count_if(drifts.begin(), drifts.end(), isOff) != 1)
    return std::nullopt;
  const auto found = std::find_if(drifts.begin(), drifts.end(), isOff);
  const Cameras knocked = {static_cast<std::size_t>(found - drifts.begin())};
  if (newClocks() == std::vector<std::string>{rig_.cameras[knocked.front()].camera.name})
    return std::nullopt;  // it is solved against the others
  return adjustedTogether(
      {without(rig_, knocked, images.to_solve), without(rig_, knocked, images.to_check)});
}

}  // namespace wiimote_tracker::continuous
