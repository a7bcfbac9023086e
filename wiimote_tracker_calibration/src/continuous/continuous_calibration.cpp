#include "continuous/continuous_calibration.h"

#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/error.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace wiimote_tracker::continuous {

namespace {

using Drifts = std::vector<std::optional<health::Drift>>;

/// How far each camera of the rig is off in these images.
Drifts driftsOf(const geometry::Rig& rig, const std::vector<capture::Image>& images, double limit) {
  // The watch judges at the end of its window at the latest.
  const double duration = images.back().stamp - images.front().stamp;
  health::DriftWatch watch(rig, {limit, duration});
  for (const capture::Image& image : images)
    watch.add(image);
  return watch.drifts();
}

/// Whether the camera fits the others with the new rig, and no other contradicts it.
bool allFit(const Drifts& drifts, std::size_t camera) {
  return drifts[camera] && std::none_of(drifts.begin(), drifts.end(), [](const auto& drift) {
           return drift && drift->ratio >= 1.0;
         });
}

/// Replaces what an earlier change has added to the verdict.
std::string verdictWith(const std::string& verdict, const std::string& change) {
  const std::string kSince = "; since then ";
  return verdict.substr(0, verdict.find(kSince)) + kSince + change;
}

}  // namespace

ContinuousCalibration::ContinuousCalibration(const geometry::Rig& rig, const Options& options)
    : rig_(rig), options_(options), knock_(rig, options.knock), drift_(rig, options.drift) {}

std::optional<Proposal> ContinuousCalibration::add(const capture::Image& image) {
  const geometry::RigCamera* camera = rig_.find(image.camera);
  if (camera == nullptr)
    return std::nullopt;
  const std::string& calibrated = camera->camera.identity;
  if (!calibrated.empty() && !image.identity.empty() && image.identity != calibrated)
    return std::nullopt;
  const auto knocked = knock_.add(image);
  const auto drifted = drift_.add(image);
  std::optional<Proposal> proposal;
  if (knocked)
    proposal = solve(Cause::kKnock, *knocked);
  if (drifted && !proposal)
    proposal = solve(Cause::kDrift, *drifted);
  return proposal;
}

void ContinuousCalibration::addAcceleration(const std::string& camera,
                                            const Eigen::Vector3d& specific_force) {
  knock_.addAcceleration(camera, specific_force);
  drift_.addAcceleration(camera, specific_force);
}

std::optional<Proposal> ContinuousCalibration::solve(Cause cause, const Evidence& evidence) const {
  if (evidence.to_check.empty())
    return std::nullopt;
  recalibrate::Request request;
  request.camera = evidence.camera;
  request.images = evidence.to_solve;
  request.gravity = evidence.gravity;
  if (cause == Cause::kDrift && !request.gravity)
    request.gravity = rig_.find(evidence.camera)->gravity;
  recalibrate::Recalibration result;
  try {
    result = recalibrate::recalibrateCamera(rig_, request, options_.recalibrate);
  } catch (const geometry::Error&) {
    return std::nullopt;  // More motion is needed, or what the camera sees is another light.
  }
  if (result.moved > options_.farthest)
    return std::nullopt;
  const auto index = static_cast<std::size_t>(rig_.find(evidence.camera) - rig_.cameras.data());
  const Drifts before = driftsOf(rig_, evidence.to_check, options_.accepted);
  const Drifts after = driftsOf(result.rig, evidence.to_check, options_.accepted);
  if (!before[index] || before[index]->ratio < 1.0 || !allFit(after, index))
    return std::nullopt;

  Proposal proposal{cause, evidence.camera, result.rig, result.moved, result.turned, 0.0, 0.0, ""};
  proposal.before = before[index]->bias.norm();
  proposal.after = after[index]->bias.norm();
  proposal.message =
      evidence.camera +
      format(
          " was turned by %.2f degrees and moved by %.1f mm (+- %.2f degrees, %.1f mm): with "
          "its new pose its images are %.2f px off what the other cameras see, before %.2f px",
          result.turned * 180.0 / M_PI, 1000.0 * result.moved,
          result.rotation_stddev * 180.0 / M_PI, 1000.0 * result.position_stddev, proposal.after,
          proposal.before);
  geometry::Rig& rig = proposal.rig;
  rig.solved_at = evidence.to_check.back().stamp;
  rig.verdict = verdictWith(rig_.verdict, proposal.message);
  return proposal;
}

}  // namespace wiimote_tracker::continuous
