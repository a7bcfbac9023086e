#include "parameters.h"

#include "identity/led_name.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/geometry/shared_views.h"
#include "wiimote_tracker_triangulation/identity/blink_codes.h"
#include "wiimote_tracker_triangulation/identity/codes_file.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <set>

namespace wiimote_tracker {
namespace {

// In the order of geometry::TriangulationMethod.
const std::vector<std::string>& methodNames() {
  static const std::vector<std::string> names = {"mean_closest", "least_squares",
                                                 "maximum_likelihood", "reweighted_midpoint"};
  return names;
}

void checkLabels(const std::string& key, const std::vector<std::string>& labels) {
  std::set<std::string> known;
  for (const std::string& label : labels) {
    const std::string what = key + " has '" + label + "'";
    if (!isWord(label) || identity::isNumbered(label))
      throw ParameterError(
          what +
          ", but each must be a letter, then letters, digits and underscores, and not led_ with a "
          "number, the name of LEDs without a label");
    if (!known.insert(label).second)
      throw ParameterError(what + " twice");
  }
}

/// @throws ParameterError: a track may not have the label of a code.
void checkCodes(const std::string& key,
                const identity::BlinkCodes& codes,
                const std::vector<std::string>& labels) {
  for (const identity::BlinkCode& code : codes.codes) {
    if (identity::isNumbered(code.label))
      throw ParameterError(key + ": rename the code " + code.label +
                           ", since led_ with a number is the name of LEDs without a label");
    if (std::count(labels.begin(), labels.end(), code.label) > 0)
      throw ParameterError(key + " and labels both have '" + code.label +
                           "': labels are for LEDs that do not blink, remove it there");
  }
}

void readInstant(ParameterReader* reader, fusion::InstantFuserOptions* instant) {
  geometry::TriangulationMethod& method = instant->triangulation.method;
  const std::string word = reader->choice(
      "instant/method", methodNames()[static_cast<std::size_t>(method)], methodNames());
  method = static_cast<geometry::TriangulationMethod>(
      std::find(methodNames().begin(), methodNames().end(), word) - methodNames().begin());
  reader->read("instant/minimum_angle", &instant->triangulation.minimum_angle, 0.001, 1.0);
  reader->read("instant/minimum_rays", &instant->minimum_rays, 2, 64);
  reader->read("instant/maximum_reprojection_error", &instant->maximum_reprojection_error, 0.1,
               1000.0);
  reader->read("instant/camera_timeout", &instant->camera_timeout, 0.01, 10.0);
  reader->read("instant/maximum_gap", &instant->maximum_gap, 0.001, instant->camera_timeout);
  reader->read("instant/maximum_spot_speed", &instant->maximum_spot_speed, 1.0, 1e6);
  reader->read("instant/maximum_range", &instant->maximum_range, 0.1, 1000.0);
  reader->read("instant/maximum_leds", &instant->maximum_leds, 1, 64);
  reader->read("instant/confirmations", &instant->confirmations, 1, 1000);
  reader->read("instant/maximum_speed", &instant->maximum_speed, 0.01, 1000.0);
  reader->read("instant/maximum_absence", &instant->maximum_absence, 0.0, 60.0);
}

void readMotion(ParameterReader* reader, motion::MotionOptions* motion) {
  for (std::size_t i = 0; i < motion->rest.size(); ++i) {
    const std::string mode = std::string("motion/") + motion::kRestModeNames[i];
    reader->read(mode + "/drift", &motion->rest[i].drift, 0.0, 1.0);
    reader->read(mode + "/start_rate", &motion->rest[i].start_rate, 0.0, 1000.0);
  }
  for (std::size_t i = 0; i < motion->moving.size(); ++i) {
    const std::string mode = std::string("motion/") + motion::kMovingModeNames[i];
    reader->read(mode + "/stddev", &motion->moving[i].stddev, 1e-4, 1000.0);
    reader->read(mode + "/time", &motion->moving[i].time, 0.001, 1000.0);
  }
  reader->read("motion/sudden_random_walk", &motion->sudden_random_walk, 0.0, 1000.0);
  reader->read("motion/stop_rate", &motion->stop_rate, 0.0, 1000.0);
  reader->read("motion/rise_rate", &motion->rise_rate, 0.0, 1000.0);
  reader->read("motion/settle_rate", &motion->settle_rate, 0.0, 1000.0);
  reader->read("motion/initial_speed", &motion->initial_speed, 0.001, 1000.0);
}

Eigen::Vector3d readCorner(ParameterReader* reader,
                           const std::string& key,
                           const Eigen::Vector3d& default_value) {
  const std::vector<double> corner =
      reader->optional(key, std::vector<double>(default_value.data(), default_value.data() + 3));
  if (corner.size() != 3 || !Eigen::Vector3d(corner.data()).allFinite())
    throw ParameterError(reader->nameOf(key) + " must be three numbers: x, y and z in metres");
  return Eigen::Vector3d(corner.data());
}

void readTracks(ParameterReader* reader, tracking::TrackerOptions* tracks) {
  reader->read("tracks/stamp_stddev", &tracks->stamp_stddev, 0.0, 0.1);
  reader->read("tracks/detection_probability", &tracks->detection_probability, 0.01, 0.999);
  reader->read("tracks/ghost_rate", &tracks->ghost_rate, 0.001, 16.0);
  reader->read("tracks/merging_distance", &tracks->merging_distance, 0.0, 100.0);
  reader->read("tracks/maximum_range", &tracks->maximum_range, 0.1, 1000.0);
  reader->read("tracks/gate", &tracks->gate, 4.0, 100.0);
  reader->read("tracks/birth_window", &tracks->birth_window, 0.001, 0.2);
  reader->read("tracks/birth_pixel_stddev", &tracks->birth_pixel_stddev, 0.1, 100.0);
  reader->read("tracks/minimum_angle", &tracks->minimum_angle, 0.001, 1.0);
  reader->read("tracks/confirmation_hits", &tracks->confirmation_hits, 1, 1000);
  reader->read("tracks/minimum_support", &tracks->minimum_support, 0.0, 1.0);
  reader->read("tracks/tracked_time", &tracks->tracked_time, 0.001, 1.0);
  reader->read("tracks/prediction_time", &tracks->prediction_time, 0.01, 10.0);
  reader->read("tracks/single_view_time", &tracks->single_view_time, 0.01, 60.0);
  reader->read("tracks/doubt_time", &tracks->doubt_time, 0.0, 5.0);
  tracks->minimum_corner = readCorner(reader, "tracks/minimum_corner", tracks->minimum_corner);
  tracks->maximum_corner = readCorner(reader, "tracks/maximum_corner", tracks->maximum_corner);
  if ((tracks->minimum_corner.array() >= tracks->maximum_corner.array()).any())
    throw ParameterError(reader->nameOf("tracks/minimum_corner") + " must be below " +
                         reader->nameOf("tracks/maximum_corner") +
                         " in x, y and z: otherwise no LED would be found");
  reader->read("tracks/history", &tracks->history, 0.01, 2.0);
}

void readIdentity(ParameterReader* reader, TrackingParameters* p) {
  IdentityOptions& identity = p->identity;
  const std::string key = reader->nameOf("identity/codes");
  const std::string file = reader->optional<std::string>("identity/codes", "");
  reader->read("identity/exposure", &identity.exposure, 0.0, 0.02);
  reader->read("identity/decide_at", &identity.identifier.decide_at, 0.6, 0.999999);
  reader->read("identity/steady", &identity.identifier.steady, 1e-9, 0.5);
  if (file.empty())
    return;
  if (p->estimator.tracker_mode != estimators::TrackerMode::kTracks)
    throw ParameterError(key + " needs " + reader->nameOf("mode") +
                         " tracks: mode instant cannot follow an LED that is off");
  try {
    identity.codes = identity::readBlinkCodes(file);
  } catch (const geometry::Error& error) {
    throw ParameterError(key + ": " + error.what());
  }
  checkCodes(key, *identity.codes, p->labels);
  p->estimator.tracks = identity::forBlinking(*identity.codes, p->estimator.tracks);
}

void readOutput(ParameterReader* reader, estimators::TrackerMode mode, OutputOptions* output) {
  reader->read("output/on_update", &output->on_update);
  reader->read("tracks/output_interval", &output->interval, 0.0, 1.0);
  reader->read("output/rate", &output->rate, 0.0, 1000.0);
  reader->read("output/predict_to_now", &output->predict_to_now);
  reader->read("output/publish_predicted", &output->publish_predicted);
  reader->read("output/led_odometry", &output->led_odometry);
  reader->read("output/body_transforms", &output->body_transforms);
  if (!output->on_update && output->rate == 0.0)
    throw ParameterError(reader->nameOf("output/rate") + " is 0 while " +
                         reader->nameOf("output/on_update") +
                         " is false, so nothing would be published: set one of them");
  if (output->predict_to_now && mode != estimators::TrackerMode::kTracks)
    throw ParameterError(reader->nameOf("output/predict_to_now") + " needs " +
                         reader->nameOf("mode") + " tracks: mode instant cannot predict");
}

}  // namespace

std::string methodWord(const estimators::EstimatorOptions& options) {
  if (options.tracker_mode == estimators::TrackerMode::kTracks)
    return "track";
  return methodNames()[static_cast<std::size_t>(options.instant.triangulation.method)];
}

std::vector<std::string> TrackingParameters::blinkingLabels() const {
  std::vector<std::string> blinking;
  if (identity.codes) {
    for (const identity::BlinkCode& code : identity.codes->codes)
      blinking.push_back(code.label);
  }
  return blinking;
}

std::vector<std::string> TrackingParameters::allLabels() const {
  std::vector<std::string> all = labels;
  for (const std::string& label : blinkingLabels())
    all.push_back(label);
  return all;
}

std::string describeIdentity(const TrackingParameters& parameters) {
  if (!parameters.identity.codes)
    return "";
  const identity::BlinkCodes& codes = *parameters.identity.codes;
  const tracking::TrackerOptions& tracks = parameters.estimator.tracks;
  return format(
      "LEDs with blink codes: %zu. They are off for up to %g s, so the tracker uses "
      "tracks/prediction_time %g s and tracks/detection_probability %g",
      codes.codes.size(), codes.longestDark(), tracks.prediction_time,
      tracks.detection_probability);
}

std::string describeLoneCamera(const geometry::Rig& rig,
                               const estimators::EstimatorOptions& options) {
  const std::string far_camera = rig.describeFarCamera();
  const bool tracks = options.tracker_mode == estimators::TrackerMode::kTracks;
  const double range = tracks ? options.tracks.maximum_range : options.instant.maximum_range;
  if (!far_camera.empty() || range >= geometry::kFarthestLed)
    return far_camera;
  const auto shared = geometry::sharedViews(rig, range);
  const auto visible = geometry::sharedViews(rig, geometry::kFarthestLed);
  for (std::size_t i = 0; i < shared.size(); ++i) {
    if (shared[i].empty() && !visible[i].empty())
      return format(
          "the view of %s meets that of no other camera within %s/maximum_range, %g m, so no LED "
          "is tracked with it: set that parameter higher",
          rig.cameras[i].camera.name.c_str(), tracks ? "tracks" : "instant", range);
  }
  return "";
}

TrackingParameters TrackingParameters::read(ParameterReader* reader) {
  TrackingParameters p;
  reader->read("labels", &p.labels);
  checkLabels(reader->nameOf("labels"), p.labels);
  reader->read("label_places", &p.label_places);
  estimators::EstimatorOptions& estimator = p.estimator;
  const bool tracks = estimator.tracker_mode == estimators::TrackerMode::kTracks;
  const std::string mode =
      reader->choice("mode", tracks ? "tracks" : "instant", {"tracks", "instant"});
  estimator.tracker_mode =
      mode == "tracks" ? estimators::TrackerMode::kTracks : estimators::TrackerMode::kInstant;
  reader->read("pixel_stddev", &estimator.tracks.pixel_stddev, 0.001, 100.0);
  reader->read("learnt_noise", &estimator.tracks.learnt_noise);
  estimator.instant.triangulation.pixel_stddev = estimator.tracks.pixel_stddev;
  readTracks(reader, &estimator.tracks);
  readMotion(reader, &estimator.tracks.motion);
  readInstant(reader, &estimator.instant);
  readIdentity(reader, &p);
  p.bodies = BodyParameters::read(reader, estimator.tracks, p.allLabels());
  readOutput(reader, estimator.tracker_mode, &p.output);
  reader->read("zones/hysteresis", &p.zones.hysteresis, 0.0, 10.0);
  reader->read("zones/timeout", &p.zones.timeout, 0.01, 60.0);
  reader->read("trigger/maximum_gap", &p.trigger.maximum_gap, 0.001, 10.0);
  reader->read("trigger/history", &p.trigger.history, 0.01, 60.0);
  reader->read("markers/rate", &p.markers.rate, 0.1, 100.0);
  reader->read("markers/image_plane_distance", &p.markers.image_plane_distance, 0.01, 10.0);
  reader->read("markers/trail_duration", &p.markers.trail_duration, 0.0, 600.0);
  reader->read("clock_tolerance", &p.clock_tolerance, 0.001, 10.0);
  reader->bounded("diagnostic_period", 1.0, 0.1, 3600.0);  // used by diagnostic_updater
  reader->refuseUnknown();
  return p;
}

}  // namespace wiimote_tracker
