#include "continuous/knocked_cameras.h"

#include "continuous/adjustment.h"
#include "health/drift_watch.h"
#include "health/tilt_watch.h"

#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/error.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace wiimote_tracker::continuous {

namespace {

constexpr double kDegreesPerRadian = 180.0 / M_PI;
// A camera that seems farther from where it was is left alone: it was put elsewhere, or it sees a
// light that moves with the LED [m].
constexpr double kFarthest = 0.2;

// Two pairs of cameras whose misfits differ by less than this ratio explain the images equally
// well.
constexpr double kAlike = 2.0;

bool contains(const Cameras& cameras, std::size_t camera) {
  return std::find(cameras.begin(), cameras.end(), camera) != cameras.end();
}

Cameras othersOf(std::size_t camera, Cameras cameras) {
  cameras.erase(std::remove(cameras.begin(), cameras.end(), camera), cameras.end());
  return cameras;
}

/// One after the other, each without the images of those after it and before it.
/// @throws geometry::Error as recalibrateCamera().
std::vector<recalibrate::Recalibration> recalibrated(geometry::Rig rig,
                                                     const Cameras& cameras,
                                                     const Evidence& evidence,
                                                     const recalibrate::Options& options) {
  std::vector<recalibrate::Recalibration> results;
  for (const std::size_t camera : cameras) {
    recalibrate::Request request;
    request.camera = rig.cameras[camera].camera.name;
    request.images = without(rig, othersOf(camera, cameras), evidence.images.to_solve);
    request.gravity = evidence.gravity[camera];
    results.push_back(recalibrate::recalibrateCamera(rig, request, options));
    rig = results.back().rig;
  }
  return results;
}

std::string sentenceOf(const std::string& camera,
                       bool new_clock,
                       const recalibrate::Recalibration& result,
                       const std::optional<health::Drift>& before,
                       const health::Drift& after) {
  return camera + (new_clock ? " reconnected with another clock and" : "") +
         format(
             " was turned by %.2f degrees and moved by %.1f mm (+- %.2f degrees, %.1f mm): with "
             "its new pose its images are %.2f px off what the other cameras see",
             result.turned * kDegreesPerRadian, 1000.0 * result.moved,
             result.rotation_stddev * kDegreesPerRadian, 1000.0 * result.position_stddev,
             after.bias.norm()) +
         (before && !new_clock ? format(", before %.2f px", before->bias.norm()) : "");
}

/// How much all cameras but these miss each other, the worst of them [px]; infinite: they
/// contradict each other, or one of them was not judged.
double misfitWithout(const geometry::Rig& rig,
                     const Cameras& cameras,
                     const std::vector<capture::Image>& images) {
  const health::Drifts drifts = health::driftsOf(rig, without(rig, cameras, images));
  if (!health::allFit(drifts, static_cast<std::ptrdiff_t>(rig.cameras.size() - cameras.size())))
    return std::numeric_limits<double>::infinity();
  double worst = 0.0;
  for (const auto& drift : drifts) {
    if (drift)
      worst = std::max(worst, std::hypot(drift->bias.norm(), drift->scatter));
  }
  return worst;
}

bool isTilted(const geometry::RigCamera& camera, const std::optional<Eigen::Vector3d>& gravity) {
  return camera.gravity && camera.gravity->norm() > 0.0 && gravity &&
         health::tiltOf(*camera.gravity, *gravity, health::TiltOptions()).ratio >= 1.0;
}

}  // namespace

std::vector<capture::Image> without(const geometry::Rig& rig,
                                    const Cameras& cameras,
                                    const std::vector<capture::Image>& images) {
  std::vector<capture::Image> rest;
  std::copy_if(images.begin(), images.end(), std::back_inserter(rest),
               [&](const capture::Image& image) {
                 return std::none_of(cameras.begin(), cameras.end(), [&](std::size_t camera) {
                   return rig.cameras[camera].camera.name == image.camera;
                 });
               });
  return rest;
}

std::optional<SolvedCameras> solveAgainstOthers(const geometry::Rig& rig,
                                                const Cameras& cameras,
                                                const Evidence& evidence,
                                                const recalibrate::Options& options) {
  const std::vector<capture::Image>& check = evidence.images.to_check;
  std::vector<recalibrate::Recalibration> results;
  try {
    results = recalibrated(rig, cameras, evidence, options);
  } catch (const geometry::Error&) {
    return std::nullopt;
  }
  const health::Drifts after = health::driftsOf(results.back().rig, check);
  health::Drifts before;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const std::size_t camera = cameras[i];
    before.push_back(health::driftsOf(rig, without(rig, othersOf(camera, cameras), check))[camera]);
    const bool was_off =
        evidence.new_clock || evidence.has_turned || (before[i] && before[i]->ratio >= 1.0);
    if (results[i].moved > kFarthest || !was_off || !after[camera])
      return std::nullopt;
  }
  if (!health::allFit(after))
    return std::nullopt;
  // The same poses; their covariance includes the drift of the others, which the checks do not
  // grant.
  recalibrate::Options unchecked = options;
  unchecked.maximum_offset_stddev = std::numeric_limits<double>::infinity();
  results = recalibrated(withDrift(rig, check.back().stamp), cameras, evidence, unchecked);
  std::vector<std::string> sentences;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (evidence.has_turned)
      before[i].reset();  // The median hardly changes with a roll.
    sentences.push_back(sentenceOf(rig.cameras[cameras[i]].camera.name, evidence.new_clock,
                                   results[i], before[i], *after[cameras[i]]));
  }
  return SolvedCameras{results.back().rig, joined(sentences, "; ")};
}

std::vector<Cameras> pairsToSolve(const geometry::Rig& rig, const Evidence& evidence) {
  std::vector<capture::Image> images = evidence.images.to_solve;
  images.insert(images.end(), evidence.images.to_check.begin(), evidence.images.to_check.end());
  std::vector<std::pair<double, Cameras>> misfits;
  const std::size_t count = rig.cameras.size();
  const health::Drifts drifts = health::driftsOf(rig, images);
  if (!std::all_of(drifts.begin(), drifts.end(),
                   [](const auto& drift) { return drift.has_value(); }))
    return {};
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = a + 1; b < count; ++b) {
      bool can_hold = true;
      for (std::size_t i = 0; i < count; ++i)
        can_hold = can_hold && (i == a || i == b || !isTilted(rig.cameras[i], evidence.gravity[i]));
      if (!can_hold)
        continue;
      const Cameras pair = {a, b};
      const double misfit = misfitWithout(rig, pair, images);
      if (std::isfinite(misfit))
        misfits.emplace_back(misfit, pair);
    }
  }
  std::sort(misfits.begin(), misfits.end());
  std::vector<Cameras> pairs;
  for (const auto& [misfit, pair] : misfits) {
    if (misfit < kAlike * misfits.front().first)
      pairs.push_back(pair);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::string contradictionOf(const geometry::Rig& rig, const std::vector<Cameras>& pairs) {
  if (pairs.size() != 2 || rig.cameras.size() != 4 || contains(pairs[0], pairs[1][0]) ||
      contains(pairs[0], pairs[1][1]))
    return "";
  const auto name = [&](std::size_t camera) { return rig.cameras[camera].camera.name; };
  const auto names = [&](const Cameras& pair) { return name(pair[0]) + " and " + name(pair[1]); };
  return names(pairs[0]) + " agree, and so do " + names(pairs[1]) +
         ", but the first two contradict the others: which two were moved is not known; put them "
         "back, or calibrate all cameras again";
}

}  // namespace wiimote_tracker::continuous
