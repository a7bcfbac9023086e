#include "continuous/adjustment.h"

#include "continuous/keyframes.h"
#include "health/drift_watch.h"

#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <tuple>

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
// The clock of a camera that did not reconnect has changed if its time offset did by more [s].
constexpr double kOtherOffset = 0.001;

/// Whether no camera has reconnected since the rig was solved.
bool clocksHold(const geometry::Rig& rig, const std::vector<capture::Image>& images) {
  return std::all_of(images.begin(), images.end(), [&](const capture::Image& image) {
    const geometry::RigCamera* const camera = rig.find(image.camera);
    return camera == nullptr || !camera->hasNewClock(image.clock_epoch);
  });
}

/// The misfit that the second fit explains and the first does not, root mean square [px]; 0: none.
double gainOf(const Fit& before, const Fit& after) {
  return std::sqrt(std::max(0.0, before.misfit * before.misfit - after.misfit * after.misfit));
}

/// A rig that may replace the one before, and how later images fit.
struct Correction {
  geometry::Rig rig;
  bool turns_cameras;  // Else it keeps the poses before.
  Fit before;          // With the rig before and new clocks, without which nothing fits.
  Fit after;
};

/// The adjusted rig, or only its clocks where cameras need not turn.
/// @returns nothing when too few places are seen.
std::optional<Correction> correctionOf(const geometry::Rig& before,
                                       const geometry::Rig& adjusted,
                                       const std::vector<capture::Image>& later) {
  const geometry::Rig same_poses = withClocks(adjusted, before);
  const auto fit_before = fitOf(withClocks(adjusted, before, true), later);
  const auto fit_of_clocks = fitOf(same_poses, later);
  const auto fit_of_all = fitOf(adjusted, later);
  if (!fit_before || !fit_of_clocks || !fit_of_all)
    return std::nullopt;
  if (gainOf(*fit_of_clocks, *fit_of_all) < kWorthTurning)
    return Correction{same_poses, false, *fit_before, *fit_of_clocks};
  return Correction{adjusted, true, *fit_before, *fit_of_all};
}

/// Whether each camera that was judged fits the others, and those that reconnected were judged.
bool camerasFit(const geometry::Rig& before,
                const geometry::Rig& now,
                const std::vector<capture::Image>& later) {
  const health::Drifts drifts = health::driftsOf(now, later);
  if (!health::allFit(drifts))
    return false;
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

Proposal dated(Proposal proposal,
               const geometry::Rig& before,
               const std::vector<capture::Image>& checked) {
  const std::string kSince = "; since then ";  // Replaces what an earlier change has added.
  const std::string& verdict = before.verdict;
  proposal.rig.verdict = verdict.substr(0, verdict.find(kSince)) + kSince + proposal.message;
  proposal.rig.solved_at = checked.back().stamp;
  return proposal;
}

std::optional<Proposal> proposeAdjustment(const geometry::Rig& before,
                                          const geometry::Rig& adjusted,
                                          const std::vector<capture::Image>& later) {
  // Another light carried along can fit, with all cameras turned farther than they drift.
  if (!clocksHold(adjusted, later) || !isWithinDrift(before, adjusted))
    return std::nullopt;
  const auto correction = correctionOf(before, adjusted, later);
  if (!correction || !camerasFit(before, correction->rig, later))
    return std::nullopt;
  const geometry::Rig& rig = correction->rig;
  const std::size_t most = mostChanged(before, rig);
  const geometry::RigCamera& was = before.cameras[most];
  const geometry::RigCamera& now = rig.cameras[most];
  const bool has_reconnected = was.hasNewClock(now.time_offset_epoch);
  const bool has_drifted = correction->turns_cameras || hasOtherOffset(was, now);
  const double gain = gainOf(correction->before, correction->after);
  if (!has_reconnected && (!has_drifted || gain < kWorthProposing))
    return std::nullopt;
  const std::string message =
      changesText(before, rig) + (has_reconnected ? "" : ": drift, or errors of the calibration") +
      format(". Corrected, the images agree to %.2f px", correction->after.misfit) +
      (has_reconnected ? "" : format(" (now %.2f px)", correction->before.misfit));
  Proposal proposal = dated({has_reconnected ? Cause::kReconnect : Cause::kDrift,
                             {now.camera.name},
                             rig,
                             has_reconnected ? 0.0 : gain,
                             message,
                             correction->after.places},
                            before, later);
  if (!correction->turns_cameras)
    proposal.rig.solved_at = before.solved_at;
  return proposal;
}

double turnOf(const geometry::RigCamera& a, const geometry::RigCamera& b) {
  return geometry::so3::angleBetween(a.camera.world_from_camera.linear(),
                                     b.camera.world_from_camera.linear());
}

}  // namespace wiimote_tracker::continuous
