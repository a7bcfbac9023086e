#include "recalibrate/recalibrate_camera.h"

#include "adjust/stamp_error.h"
#include "capture/camera_monitor.h"
#include "capture/moving_spots.h"
#include "resection.h"
#include "rig_cameras.h"
#include "seen_path.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/point_sensitivity.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace wiimote_tracker::recalibrate {

namespace {

using geometry::firstParameter;
using geometry::kIntrinsics;
using geometry::kParameters;
using geometry::kPosition;
using geometry::kRotation;
using geometry::kTimeOffset;

constexpr double kDegrees = 180.0 / M_PI;  // in one radian
constexpr double kRefuseRatio = 6.0;       // of the estimated noise to Options::pixel
// Standard deviation of the path along its longest axis [m].
constexpr double kMinimumExtent = 0.1;
// Largest standard deviation of a predicted pixel due to the camera's uncertainty, the others being
// exact: RMS [px]. The camera's position alone says little: a longer lens further away sees the
// same.
constexpr double kLargestImageError = 2.0;
// The distortion beyond k1, which is not estimated, in geometry/camera_parameters.h.
constexpr Eigen::Index kHeld = kIntrinsics + adjust::kLensSize;
constexpr Eigen::Index kHeldSize = adjust::kHigherDistortionSize;
// Number of matches for which the derivatives by the others' parameters are computed.
constexpr std::size_t kDerivatives = 200;

void checkInput(const geometry::Rig& rig, const Request& request, const Options& options) {
  rig.check();
  if (const std::string reason = whyUnsolvable(rig, request.camera, options); !reason.empty())
    throw Error(reason);
  bool sends_images = false;
  for (const capture::Image& image : request.images) {
    if (!std::isfinite(image.stamp))
      throw Error("an image of " + image.camera + " has no time: correct its stamp");
    sends_images = sends_images || image.camera == request.camera;
  }
  if (!sends_images)
    throw Error(request.camera + " " + capture::kSendsNoImages);
}

/// The prior of the camera: its lens is the rig's, unless it is new or another device.
/// @param images of the camera
Prior priorOf(const geometry::Rig& rig,
              const Request& request,
              const std::vector<capture::Image>& images,
              const Options& options) {
  const geometry::RigCamera* const calibrated = rig.find(request.camera);
  Prior prior;
  prior.lens = request.intrinsics;
  prior.uncertainty = options.uncertainty;
  if (!calibrated || calibrated->camera.isOtherDevice(request.identity))
    return prior;
  prior.lens = calibrated->camera.intrinsics;
  const auto index = static_cast<std::size_t>(calibrated - rig.cameras.data());
  const Eigen::Index first = firstParameter(index) + kIntrinsics;
  if (geometry::hasCovariance(rig))
    prior.lens_covariance =
        rig.covariance.block<adjust::kLensSize, adjust::kLensSize>(first, first);
  // A start value; the offset is estimated again.
  if (!images.empty())
    prior.time_offset = calibrated->timeOffsetIn(images.front().clock_epoch).value_or(0.0);
  return prior;
}

void checkOthers(const geometry::Rig& rig, const SeenPath& path) {
  if (path.cameras().size() >= 2)
    return;
  const std::string seeing =
      path.cameras().empty() ? "none" : rig.cameras[path.cameras().front()].camera.name + " alone";
  throw Error("of the other cameras " + seeing +
              " saw the LED as its only moving light, but two are needed: wave where "
              "they see it, and switch off other lights");
}

void checkFit(const Fit& fit, const Options& options) {
  const std::string& name = fit.camera.name;
  const auto found = fit.matches.size();
  if (fit.contradictory > found + fit.undetermined)
    throw Error(
        "the other cameras contradict each other most of the time: they see different lights, or "
        "another one was moved; see that only the LED shines, or calibrate all of them again");
  if (static_cast<double>(found) < capture::kLeastFitting * static_cast<double>(fit.expected))
    throw Error(
        format("only %zu of %zu images of %s fit to what the others saw: it moved while the LED "
               "was waved, or sees another light; fix that and wave again",
               found, fit.expected, name.c_str()));

  // Before the residuals, which are large where a flat path lets the pose go wrong.
  std::vector<Eigen::Vector3d> positions;
  for (const Match& match : fit.matches)
    positions.push_back(match.point.position);
  const Eigen::Vector3d extent = geometry::spreadOf(positions);
  if (extent[0] < kMinimumExtent)
    throw Error("the LED moved by " + format("%.2f m", extent[0]) +
                " only: wave it through the whole volume");
  if (extent[2] < capture::kThinnestPath * extent[0])
    throw Error(
        "the LED stayed on a line or in a plane: wave it through the whole volume, up and down "
        "and near and far");
  if (fit.pixel_stddev > kRefuseRatio * options.pixel)
    throw Error("the images of " + name + " are " + format("%.1f px", fit.pixel_stddev) +
                " off what the others saw: its starting intrinsics are wrong, or the "
                "others were moved too; calibrate all of them again");
}

/// How the camera's estimate changes with each parameter of the rig: inverse of the information
/// times the change of the normal equations' right-hand side. The distortion beyond k1 keeps the
/// rig's value, and its error enters the other parameters (a consider parameter: Tapley, Schutz and
/// Born, Statistical Orbit Determination, 2004).
Eigen::MatrixXd sensitivityToRig(const geometry::Rig& rig,
                                 std::size_t index,
                                 const Prior& prior,
                                 const Fit& fit,
                                 const ParameterMatrix& covariance) {
  const Eigen::Index size = firstParameter(rig.cameras.size());
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(kParameters, size);
  const std::size_t stride = std::max<std::size_t>(1, fit.matches.size() / kDerivatives);
  double used = 0.0;
  for (std::size_t i = 0; i < fit.matches.size(); i += stride) {
    const Match& match = fit.matches[i];
    const auto expected = projectionOf(fit.camera, match.point);
    const auto point_by_parameters = geometry::pointByParameters(
        rig, match.point.position, match.point.cameras, match.point.velocity);
    if (!expected || !point_by_parameters)
      continue;
    // The prediction moves with the point.
    const geometry::ParameterJacobian own = match.whitening * expected->by_parameters;
    right -= own.transpose() * match.whitening * expected->by_point * *point_by_parameters;
    if (prior.lens_covariance)
      right.middleCols<kHeldSize>(firstParameter(index) + kHeld) -=
          own.transpose() * own.middleCols<kHeldSize>(kHeld);
    used += 1.0;
  }
  right *= static_cast<double>(fit.matches.size()) / used;
  // The prior mean of the lens is a parameter of the rig, too.
  if (prior.lens_covariance)
    right.block<adjust::kLensSize, adjust::kLensSize>(
        kIntrinsics, firstParameter(index) + kIntrinsics) += prior.lensInformation();
  Eigen::MatrixXd by_rig = covariance * right;
  if (prior.lens_covariance)
    by_rig.block<kHeldSize, kHeldSize>(kHeld, firstParameter(index) + kHeld).setIdentity();
  return by_rig;
}

/// Writes the camera's block and its cross covariances into the rig's covariance.
/// @param covariance of the camera's parameters, the others being exact.
/// @returns the camera's block.
ParameterMatrix updateCovariance(const SeenPath& path,
                                 std::size_t index,
                                 const Prior& prior,
                                 const Options& options,
                                 const Fit& fit,
                                 const ParameterMatrix& covariance,
                                 geometry::Rig* rig) {
  ParameterMatrix own = covariance;
  // What the prior of the lens contributes comes with the rig's covariance, below.
  if (prior.lens_covariance)
    own -= covariance.middleCols<adjust::kLensSize>(kIntrinsics) * prior.lensInformation() *
           covariance.middleRows<adjust::kLensSize>(kIntrinsics);
  own(kTimeOffset, kTimeOffset) += adjust::meanStampVariance(options.wander, fit.duration);
  if (!geometry::hasCovariance(*rig))
    return own;
  const Eigen::MatrixXd by_rig = sensitivityToRig(*rig, index, prior, fit, covariance);
  Eigen::MatrixXd others = rig->covariance;
  for (const std::size_t i : path.cameras()) {
    if (!path.clockKnown(i)) {
      const Eigen::Index k = firstParameter(i) + kTimeOffset;
      others(k, k) += capture::kUnknownOffset * capture::kUnknownOffset;
    }
  }
  own += geometry::propagated(by_rig, others);
  const Eigen::MatrixXd common = by_rig * rig->covariance;
  const Eigen::Index first = firstParameter(index);
  rig->covariance.middleRows<kParameters>(first) = common;
  rig->covariance.middleCols<kParameters>(first) = common.transpose();
  rig->covariance.block<kParameters, kParameters>(first, first) = own;
  return own;
}

/// RMS standard deviation of the predicted pixels due to the camera's uncertainty, the others being
/// exact [px].
double imageError(const Fit& fit, const ParameterMatrix& covariance) {
  double squared = 0.0;
  for (const Match& match : fit.matches) {
    if (const auto expected = projectionOf(fit.camera, match.point)) {
      const geometry::ParameterJacobian& by_parameters = expected->by_parameters;
      squared += geometry::propagated(by_parameters, covariance).trace();
    }
  }
  return std::sqrt(squared / static_cast<double>(fit.matches.size()));
}

void checkCertainty(const Fit& fit,
                    const SeenPath& path,
                    const ParameterMatrix& covariance,
                    const Recalibration& result,
                    const Options& options) {
  const std::string& name = fit.camera.name;
  const std::vector<geometry::RigCamera>& cameras = result.rig.cameras;
  std::vector<std::string> unclocked;  // a longer wave does not help against their offsets
  for (const std::size_t i : path.cameras()) {
    if (!path.clockKnown(i))
      unclocked.push_back(cameras[i].camera.name);
  }
  // Else continuous calibration finds no clocks.
  const bool were_known = std::all_of(cameras.begin(), cameras.end(), [](const auto& camera) {
    return camera.time_offset_rule != geometry::TimeOffsetRule::kNone;
  });
  if (result.offset_stddev > options.maximum_offset_stddev)
    throw Error(
        "the time offset of " + name +
        format(" would be known to %.2f ms only, but %.2f ms are needed: ",
               1000.0 * result.offset_stddev, 1000.0 * options.maximum_offset_stddev) +
        (unclocked.empty()
             ? "wave longer and faster"
             : "those of " + joined(unclocked) + " are not known" +
                   (were_known ? " since a reconnection; move one LED where all cameras see it, "
                                 "apply what is then proposed (A in calibrate), and recalibrate " +
                                     name + " again"
                               : "; calibrate all cameras again, with a waved LED")));
  const double error = imageError(fit, covariance);
  if (error > kLargestImageError)
    throw Error("where " + name + " sees a point would be known to " + format("%.1f px", error) +
                " only: wave longer, through the whole volume that it sees");
}

/// The camera as it is now.
geometry::RigCamera rigCamera(const geometry::RigCamera& before,
                              const Request& request,
                              std::uint32_t clock_epoch,
                              const Fit& fit) {
  geometry::RigCamera camera = before;
  camera.camera = fit.camera;
  if (!request.identity.empty())
    camera.camera.identity = request.identity;
  camera.gravity = request.gravity;
  camera.time_offset = fit.time_offset;
  camera.time_offset_rule = geometry::TimeOffsetRule::kOneEpoch;
  camera.time_offset_epoch = clock_epoch;
  camera.observations = static_cast<std::uint32_t>(fit.expected);
  camera.inliers = static_cast<std::uint32_t>(fit.matches.size());
  const geometry::Intrinsics& lens = fit.camera.intrinsics;
  double squared_scale = 0.0;  // sum of the squared sizes of a pixel at the LED [m^2/px^2]
  for (const Match& match : fit.matches)
    squared_scale +=
        (match.point.position - fit.camera.center()).squaredNorm() / (lens.fx * lens.fy);
  // Without what the points' errors add: it is to tell the noise of this camera.
  camera.residual_px = std::sqrt(2.0) * fit.pixel_stddev;
  camera.residual_m = camera.residual_px * std::sqrt(squared_scale / camera.inliers);
  return camera;
}

}  // namespace

std::string whyUnsolvable(const geometry::Rig& rig,
                          const std::string& camera,
                          const Options& options) {
  if (rig.ray_model != geometry::RayModel::kCalibrated)
    return "the rig's rays are built through the image centre, which does not fit its cameras: "
           "calibrate all of it again";
  int others = 0, clocks = 0;
  for (const geometry::RigCamera& each : rig.cameras) {
    if (each.camera.name == camera)
      continue;
    ++others;
    clocks += each.time_offset_rule != geometry::TimeOffsetRule::kNone;
  }
  if (others < 2)
    return "one camera is solved against two others or more, but the rig has " +
           std::to_string(others) + " beside " + camera + ": calibrate all cameras again";
  // The offset is against the mean of the others, at best.
  if (clocks < 2 && geometry::hasCovariance(rig) &&
      capture::kUnknownOffset > options.maximum_offset_stddev * std::sqrt(others))
    return "at most one of the other cameras has a known clock, as after a calibration by the "
           "square alone, so that " +
           camera + " cannot be solved against them: calibrate all cameras again, with a waved LED";
  return "";
}

Recalibration recalibrateCamera(const geometry::Rig& before,
                                const Request& request,
                                const Options& options) {
  checkInput(before, request, options);
  const bool is_new = !before.find(request.camera);
  const geometry::Rig rig = is_new ? withCamera(before, request.camera) : before;
  const auto index = static_cast<std::size_t>(rig.find(request.camera) - rig.cameras.data());
  const SeenPath path(rig, request.images, request.camera);
  checkOthers(rig, path);
  const std::vector<capture::Image> images =
      capture::latestImagesOf(request.camera, request.images);
  const Prior prior = priorOf(before, request, images, options);
  geometry::Camera start = rig.cameras[index].camera;
  start.intrinsics = prior.lens;
  const Fit fit = resect(path, images, start, prior, options);
  checkFit(fit, options);

  Recalibration result;
  result.rig = rig;
  const ParameterMatrix exact_others = covarianceOf(fit, prior);
  const ParameterMatrix covariance =
      updateCovariance(path, index, prior, options, fit, exact_others, &result.rig);
  result.rotation_stddev = std::sqrt(covariance.diagonal().segment<3>(kRotation).sum());
  result.position_stddev = std::sqrt(covariance.diagonal().segment<3>(kPosition).sum());
  result.offset_stddev = std::sqrt(covariance(kTimeOffset, kTimeOffset));
  result.rig.cameras[index] =
      rigCamera(rig.cameras[index], request, images.back().clock_epoch, fit);
  checkCertainty(fit, path, exact_others, result, options);
  std::string change = " was added";
  if (!is_new) {
    const Eigen::Isometry3d& then = rig.cameras[index].camera.world_from_camera;
    const Eigen::Isometry3d& now = fit.camera.world_from_camera;
    result.moved = (now.translation() - then.translation()).norm();
    result.turned = geometry::so3::angleBetween(then.linear(), now.linear());
    change = format(" moved by %.1f mm and turned by %.2f degrees", 1000.0 * result.moved,
                    result.turned * kDegrees);
  }
  result.message =
      request.camera + change +
      format(
          "; it is known to %.1f mm and %.2f degrees, from %zu images; check a known place, "
          "then save the rig",
          1000.0 * result.position_stddev, result.rotation_stddev * kDegrees, fit.matches.size());
  const std::string how = (is_new ? "+added " : "+recalibrated ") + request.camera;
  // The name of a camera may begin with that of another one.
  if ((rig.method + "+").find(how + "+") == std::string::npos)
    result.rig.method += how;
  result.rig.verdict += (rig.verdict.empty() ? "" : "; ") + result.message;
  result.rig.check();
  return result;
}

}  // namespace wiimote_tracker::recalibrate
