#include "parameters.h"

#include "file_paths.h"

#include <wiimote_tracker_msgs/parameter_reader.h>
#include <wiimote_tracker_msgs/ros_home.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace wiimote_tracker {

namespace {

void readCapture(ParameterReader* reader, capture::CornerCaptureOptions* options) {
  reader->read("minimum_samples", &options->minimum_samples, 10, 100000);
  reader->read("minimum_cameras", &options->minimum_cameras, 1, 1000);
  reader->read("spread_limit", &options->spread_limit, 0.01, 1000.0);
  reader->read("drift_limit", &options->drift_limit, 0.01, 1000.0);
  reader->read("capture_timeout", &options->timeout, 0.1, 3600.0);
}

void readCoverage(ParameterReader* reader, wave::CoverageOptions* options) {
  reader->read("wave_seconds", &options->seconds, 1.0, 600.0);
  reader->read("wave_image_share", &options->image_share, 0.0, 1.0);
  reader->read("wave_image_speed", &options->image_speed, 0.0, 1e4);
  reader->read("wave_volume", &options->volume, 0.0, 1e4);
  reader->read("wave_speed", &options->speed, 0.0, 10.0);
  reader->read("wave_distraction", &options->distraction, 0.0, 1.0);
}

void readWave(ParameterReader* reader, wave::WaveModel* model) {
  reader->read("wave_pixel_stddev", &model->pixel, 1e-3, 100.0);
  reader->read("stamp_stddev", &model->stamp, 0.0, 1.0);
  reader->read("stamp_wander", &model->wander, 0.0, 1.0);
  reader->read("time_offset_stddev", &model->offset, 1e-6, 10.0);
  reader->read("knot_spacing", &model->knot_spacing, 0.005, 0.05);
  reader->read("wave_acceleration", &model->acceleration, 0.1, 1e4);
  reader->read("maximum_offset_stddev", &model->maximum_offset_stddev, 1e-6, 10.0);
}

void readRays(ParameterReader* reader, samples::SolveOptions* options) {
  const std::string correction =
      reader->choice("principal_point_correction", "none", {"none", "origin", "corners"});
  options->correct_principal_points = correction != "none";
  options->correction.points = correction == "corners" ? principal_point::Points::kAllCorners
                                                       : principal_point::Points::kOrigin;
  reader->read("correction_rounds", &options->correction.rounds, 0, 1000);
  reader->read("correction_limit", &options->correction.limit, 0.0, 1000.0);
  const std::string rays =
      reader->choice("ray_model", "calibrated", {"calibrated", "image_center"});
  options->ray_model =
      rays == "calibrated" ? geometry::RayModel::kCalibrated : geometry::RayModel::kImageCenter;
  const double hfov = reader->bounded("virtual_hfov", 0.0, 0.0, 3.0);
  if (hfov > 0.0)
    options->virtual_hfov = hfov;
}

void readSolve(ParameterReader* reader, square::SolveOptions* options) {
  const std::string method = reader->choice("method", "joint", {"joint", "per_camera"});
  options->method = method == "joint" ? square::Method::kJoint : square::Method::kPerCamera;
  square::Uncertainty& u = options->uncertainty;
  reader->read("pixel_stddev", &u.pixel, 1e-3, 100.0);
  reader->read("placement_stddev", &u.placement, 1e-6, 10.0);
  reader->read("focal_stddev", &u.focal, 1e-6, 1.0);
  reader->read("aspect_stddev", &u.aspect, 1e-6, 1.0);
  reader->read("principal_point_stddev", &u.principal_point, 1e-3, 10000.0);
  reader->read("shared_principal_point_stddev", &u.shared_principal_point, 0.0, 10000.0);
  reader->read("k1_stddev", &u.k1, 1e-6, 10.0);
  reader->read("gravity_stddev", &u.gravity, 1e-3, 3.2);
  reader->read("branch_odds", &options->branch_odds, 1.5, 1e9);
}

void readHealth(ParameterReader* reader, health::HealthOptions* options) {
  health::TiltOptions& tilt = options->tilt;
  reader->read("bump_limit", &tilt.limit, 1e-4, 1.0);
  reader->read("bump_window", &tilt.window, 1.0, 3600.0);
  reader->read("accelerometer_resolution", &tilt.resolution, 0.0, 10.0);
  health::DriftOptions& drift = options->drift;
  reader->read("residual_drift_limit", &drift.limit, 0.01, 1000.0);
  reader->read("residual_drift_window", &drift.window, 5.0, 3600.0);
}

ContinuousPolicy readContinuousPolicy(ParameterReader* reader) {
  const std::string policy =
      reader->choice("continuous_policy", "propose", {"off", "propose", "knocked", "all"});
  if (policy == "off")
    return ContinuousPolicy::kOff;
  if (policy == "propose")
    return ContinuousPolicy::kPropose;
  return policy == "knocked" ? ContinuousPolicy::kKnocked : ContinuousPolicy::kAll;
}

geometry::Intrinsics readIntrinsics(ParameterReader* reader,
                                    const std::string& key,
                                    geometry::Intrinsics lens) {
  const std::string prefix = key + "/";
  reader->read(prefix + "width", &lens.width, 1, 100000);
  reader->read(prefix + "height", &lens.height, 1, 100000);
  reader->read(prefix + "fx", &lens.fx, 1.0, 1e6);
  reader->read(prefix + "fy", &lens.fy, 1.0, 1e6);
  reader->read(prefix + "cx", &lens.cx, -1e5, 1e5);
  reader->read(prefix + "cy", &lens.cy, -1e5, 1e5);
  std::vector<std::string> models;
  for (const geometry::DistortionModel known : geometry::kDistortionModels)
    models.emplace_back(geometry::nameOf(known));
  const std::string model =
      reader->choice(prefix + "distortion_model", geometry::nameOf(lens.distortion_model), models);
  if (model != geometry::nameOf(lens.distortion_model))
    lens.distortion.fill(0.0);
  lens.distortion_model = *geometry::distortionModelFromName(model);
  const auto count = static_cast<std::ptrdiff_t>(geometry::coefficientCount(lens.distortion_model));
  const std::vector<double> distortion = reader->optional<std::vector<double>>(
      prefix + "distortion", {lens.distortion.begin(), lens.distortion.begin() + count});
  const bool finite = std::all_of(distortion.begin(), distortion.end(),
                                  [](double value) { return std::isfinite(value); });
  if (static_cast<std::ptrdiff_t>(distortion.size()) != count || !finite)
    throw ParameterError(reader->nameOf(prefix + "distortion") + " must have the numbers " +
                         geometry::coefficientNames(lens.distortion_model));
  std::copy(distortion.begin(), distortion.end(), lens.distortion.begin());
  return lens;
}

/// Names below cameras_intrinsics. A name may contain slashes; its keys are the last part.
std::set<std::string> camerasWithOwnIntrinsics(const ParameterReader& reader) {
  const std::string prefix = reader.nameOf("cameras_intrinsics") + "/";
  std::set<std::string> names;
  for (const std::string& name : reader.fullNames()) {
    if (name.compare(0, prefix.size(), prefix) != 0)
      continue;
    const std::string rest = name.substr(prefix.size());
    const std::size_t slash = rest.rfind('/');
    if (slash != std::string::npos)
      names.insert(rest.substr(0, slash));
  }
  return names;
}

}  // namespace

Parameters readParameters(ParameterReader* reader) {
  Parameters parameters;
  workflow::CalibrationOptions& calibration = parameters.calibration;
  parameters.cameras = reader->optional<std::vector<std::string>>("cameras", {});
  parameters.side_length = reader->bounded("side_length", 0.0, 0.0, 20.0);
  parameters.second_side_length = reader->bounded("second_side_length", 0.0, 0.0, 20.0);
  parameters.rig_file = reader->optional<std::string>("rig_file", "");
  if (parameters.rig_file.empty())
    parameters.rig_file = rosHome() + "/wiimote_tracker/" + kRigFile;
  parameters.file_folder = reader->optional<std::string>("file_folder", "");
  reader->read("led_height", &calibration.layout.led_height, 0.0, 2.0);
  reader->read("world_frame", &calibration.world_frame);
  if (calibration.world_frame.empty())
    throw ParameterError(reader->nameOf("world_frame") + " is empty: give the frame a name");
  if (calibration.world_frame.front() == '/')
    throw ParameterError(reader->nameOf("world_frame") + " is " + calibration.world_frame +
                         ", but tf2 refuses frames that begin with /: leave that out");
  reader->read("origin_x", &calibration.layout.origin.x(), -1000.0, 1000.0);
  reader->read("origin_y", &calibration.layout.origin.y(), -1000.0, 1000.0);
  reader->read("yaw", &calibration.layout.yaw, -2.0 * M_PI, 2.0 * M_PI);
  readCapture(reader, &calibration.capture);
  reader->read("hands_free", &parameters.hands_free);
  reader->read("sounds", &parameters.sounds);
  reader->read("hands_free_hold", &calibration.hands_free.hold, 0.5, 60.0);
  reader->read("hands_free_distance", &calibration.hands_free.distance, 5.0, 10000.0);
  calibration.hands_free.minimum_cameras = calibration.capture.minimum_cameras;
  parameters.button_remote = reader->optional<std::string>("button_remote", "");
  if (std::count(parameters.cameras.begin(), parameters.cameras.end(), parameters.button_remote) >
      0)
    throw ParameterError(reader->nameOf("button_remote") + " is " + parameters.button_remote +
                         ", which is one of the cameras, and pressing moves it: name a spare "
                         "remote that is held in the hand");
  reader->read("mask_share", &parameters.masks.share, 0.001, 1.0);
  reader->read("mask_margin", &parameters.masks.margin, 0.0, 1000.0);
  readCoverage(reader, &calibration.coverage);
  readSolve(reader, &parameters.solve.square);
  readWave(reader, &parameters.solve.wave);
  readRays(reader, &parameters.solve);
  readHealth(reader, &parameters.health);
  parameters.continuous_policy = readContinuousPolicy(reader);
  reader->bounded("diagnostic_period", 1.0, 0.1, 3600.0);  // used by diagnostic_updater
  reader->read("use_gravity", &parameters.solve.use_gravity);
  reader->read("set_camera_info_timeout", &parameters.set_camera_info_timeout, 0.1, 60.0);
  reader->read("board_column_spacing", &parameters.board.column_spacing, 0.001, 10.0);
  const double row_spacing = reader->bounded("board_row_spacing", 0.0, 0.0, 10.0);
  parameters.board.row_spacing = row_spacing > 0.0 ? row_spacing : parameters.board.column_spacing;
  reader->read("board_views", &parameters.board_views, 3, 1000);
  parameters.intrinsics = readIntrinsics(reader, "intrinsics", parameters.intrinsics);
  for (const std::string& name : camerasWithOwnIntrinsics(*reader))
    parameters.own_intrinsics[name] =
        readIntrinsics(reader, "cameras_intrinsics/" + name, parameters.intrinsics);
  reader->refuseUnknown();
  return parameters;
}

const geometry::Intrinsics& Parameters::intrinsicsOf(const std::string& camera) const {
  const auto own = own_intrinsics.find(camera);
  return own != own_intrinsics.end() ? own->second : intrinsics;
}

recalibrate::Options Parameters::recalibrateOptions() const {
  return {solve.wave, solve.square.uncertainty};
}

}  // namespace wiimote_tracker
