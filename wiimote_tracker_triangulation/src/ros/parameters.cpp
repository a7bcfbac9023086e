#include "parameters.h"

#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/identity/blinking_tracks.h"
#include "wiimote_tracker_triangulation/identity/codes_file.h"

#include <algorithm>
#include <set>
#include <sstream>

namespace wiimote_tracker {
namespace {

// In the order of geometry::TriangulationMethod.
const std::vector<std::string>& methodNames() {
  static const std::vector<std::string> names = {"mean_closest", "least_squares",
                                                 "maximum_likelihood", "reweighted_midpoint"};
  return names;
}

bool isWord(const std::string& text) {
  const auto isLetter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  return !text.empty() && isLetter(text[0]) && std::all_of(text.begin(), text.end(), [&](char c) {
    return isLetter(c) || (c >= '0' && c <= '9') || c == '_';
  });
}

/// Whether a track without a listed label could be called so.
bool isNumbered(const std::string& label) {
  const std::string prefix = "led_";
  return label.compare(0, prefix.size(), prefix) == 0 && label.size() > prefix.size() &&
         label.find_first_not_of("0123456789", prefix.size()) == std::string::npos;
}

std::vector<std::string> checkedLabels(const std::string& key,
                                       const std::vector<std::string>& labels) {
  std::set<std::string> known;
  for (const std::string& label : labels) {
    if (!isWord(label) || isNumbered(label))
      throw ParameterError(key + " has '" + label +
                           "', but each must be a letter, then letters, digits and underscores, "
                           "and not led_ with a number, which is what further LEDs are called");
    if (!known.insert(label).second)
      throw ParameterError(key + " has '" + label + "' twice");
  }
  return labels;
}

/// A blink code's label is a track's name as well.
void checkCodes(const std::string& key,
                const identity::BlinkCodes& codes,
                const std::vector<std::string>& labels) {
  for (const identity::BlinkCode& code : codes.codes) {
    if (isNumbered(code.label))
      throw ParameterError(key + ": rename the code " + code.label +
                           ", since led_ with a number is what LEDs without a label are called");
    if (std::count(labels.begin(), labels.end(), code.label) > 0)
      throw ParameterError(key + " and labels both have '" + code.label +
                           "': labels are for LEDs that do not blink, take it out there");
  }
}

/// Reads the numbers of one group.
class Group {
 public:
  Group(const std::string& name, ParameterReader* reader) : name_(name), reader_(reader) {}

  void read(const std::string& key, double minimum, double maximum, double* value) const {
    *value = reader_->bounded(name_ + "/" + key, *value, minimum, maximum);
  }

  void read(const std::string& key, int minimum, int maximum, std::size_t* value) const {
    *value = static_cast<std::size_t>(
        reader_->bounded(name_ + "/" + key, static_cast<int>(*value), minimum, maximum));
  }

 private:
  std::string name_;
  ParameterReader* reader_;
};

void readInstant(ParameterReader* reader, fusion::InstantFuserOptions* instant) {
  geometry::TriangulationMethod& method = instant->triangulation.method;
  const std::string word = reader->choice(
      "instant/method", methodNames()[static_cast<std::size_t>(method)], methodNames());
  method = static_cast<geometry::TriangulationMethod>(
      std::find(methodNames().begin(), methodNames().end(), word) - methodNames().begin());
  const Group group("instant", reader);
  group.read("minimum_angle", 0.001, 1.0, &instant->triangulation.minimum_angle);
  group.read("minimum_rays", 2, 64, &instant->minimum_rays);
  group.read("maximum_reprojection_error", 0.1, 1000.0, &instant->maximum_reprojection_error);
  group.read("camera_timeout", 0.01, 10.0, &instant->camera_timeout);
  group.read("maximum_gap", 0.001, instant->camera_timeout, &instant->maximum_gap);
  group.read("maximum_spot_speed", 1.0, 1e6, &instant->maximum_spot_speed);
  group.read("maximum_range", 0.1, 1000.0, &instant->maximum_range);
  group.read("maximum_leds", 1, 64, &instant->maximum_leds);
  group.read("confirmations", 1, 1000, &instant->confirmations);
  group.read("maximum_speed", 0.01, 1000.0, &instant->maximum_speed);
  group.read("maximum_absence", 0.0, 60.0, &instant->maximum_absence);
}

void readMotion(ParameterReader* reader, motion::MotionOptions* motion) {
  const Group group("motion", reader);
  group.read("fixed/drift", 0.0, 1.0, &motion->fixed.drift);
  group.read("fixed/start_rate", 0.0, 1000.0, &motion->fixed.start_rate);
  group.read("swaying/drift", 0.0, 1.0, &motion->swaying.drift);
  group.read("swaying/start_rate", 0.0, 1000.0, &motion->swaying.start_rate);
  group.read("smooth/stddev", 1e-4, 1000.0, &motion->smooth.stddev);
  group.read("smooth/time", 0.001, 1000.0, &motion->smooth.time);
  group.read("gentle/stddev", 1e-4, 1000.0, &motion->gentle.stddev);
  group.read("gentle/time", 0.001, 1000.0, &motion->gentle.time);
  group.read("brisk/stddev", 1e-4, 1000.0, &motion->brisk.stddev);
  group.read("brisk/time", 0.001, 1000.0, &motion->brisk.time);
  group.read("sudden_random_walk", 0.0, 1000.0, &motion->sudden_random_walk);
  group.read("stop_rate", 0.0, 1000.0, &motion->stop_rate);
  group.read("rise_rate", 0.0, 1000.0, &motion->rise_rate);
  group.read("settle_rate", 0.0, 1000.0, &motion->settle_rate);
  group.read("initial_speed", 0.001, 1000.0, &motion->initial_speed);
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
  const Group group("tracks", reader);
  group.read("stamp_stddev", 0.0, 0.1, &tracks->stamp_stddev);
  group.read("detection_probability", 0.01, 0.999, &tracks->detection_probability);
  group.read("ghost_rate", 0.001, 16.0, &tracks->ghost_rate);
  group.read("merging_distance", 0.0, 100.0, &tracks->merging_distance);
  group.read("maximum_range", 0.1, 1000.0, &tracks->maximum_range);
  group.read("gate", 4.0, 100.0, &tracks->gate);
  group.read("birth_window", 0.001, 0.2, &tracks->birth_window);
  group.read("birth_pixel_stddev", 0.1, 100.0, &tracks->birth_pixel_stddev);
  group.read("minimum_angle", 0.001, 1.0, &tracks->minimum_angle);
  group.read("confirmation_hits", 1, 1000, &tracks->confirmation_hits);
  group.read("minimum_support", 0.0, 1.0, &tracks->minimum_support);
  group.read("tracked_time", 0.001, 1.0, &tracks->tracked_time);
  group.read("prediction_time", 0.01, 10.0, &tracks->prediction_time);
  group.read("single_view_time", 0.01, 60.0, &tracks->single_view_time);
  group.read("doubt_time", 0.0, 5.0, &tracks->doubt_time);
  tracks->minimum_corner = readCorner(reader, "tracks/minimum_corner", tracks->minimum_corner);
  tracks->maximum_corner = readCorner(reader, "tracks/maximum_corner", tracks->maximum_corner);
  if ((tracks->minimum_corner.array() >= tracks->maximum_corner.array()).any())
    throw ParameterError(reader->nameOf("tracks/minimum_corner") + " must be below " +
                         reader->nameOf("tracks/maximum_corner") +
                         " in x, y and z: otherwise no LED would be found");
  group.read("history", 0.01, 2.0, &tracks->history);
  group.read("output_interval", 0.0, 1.0, &tracks->output_interval);
}

void readIdentity(ParameterReader* reader, TrackingParameters* p) {
  IdentityOptions& identity = p->identity;
  const std::string key = reader->nameOf("identity/codes");
  const std::string file = reader->optional<std::string>("identity/codes", "");
  const Group group("identity", reader);
  group.read("exposure", 0.0, 0.02, &identity.exposure);
  group.read("decide_at", 0.6, 0.999999, &identity.identifier.decide_at);
  group.read("steady", 1e-9, 0.5, &identity.identifier.steady);
  if (file.empty())
    return;
  if (p->estimator.mode != tracking::Mode::kTracks)
    throw ParameterError(key + " needs " + reader->nameOf("mode") +
                         " tracks: single instants follow no LED through its darkness");
  try {
    identity.codes = identity::readBlinkCodes(file);
  } catch (const geometry::Error& error) {
    throw ParameterError(key + ": " + error.what());
  }
  checkCodes(key, *identity.codes, p->labels);
  p->estimator.tracks = identity::forBlinking(*identity.codes, p->estimator.tracks);
}

void readOutput(ParameterReader* reader, tracking::Mode mode, OutputOptions* output) {
  output->on_update = reader->optional("output/on_update", output->on_update);
  output->rate = reader->bounded("output/rate", output->rate, 0.0, 1000.0);
  output->predict_to_now = reader->optional("output/predict_to_now", output->predict_to_now);
  output->publish_predicted =
      reader->optional("output/publish_predicted", output->publish_predicted);
  if (!output->on_update && output->rate == 0.0)
    throw ParameterError(reader->nameOf("output/rate") + " is 0 while " +
                         reader->nameOf("output/on_update") +
                         " is false, so that nothing would go out: set one of them");
  if (output->predict_to_now && mode != tracking::Mode::kTracks)
    throw ParameterError(reader->nameOf("output/predict_to_now") + " needs " +
                         reader->nameOf("mode") + " tracks: single instants predict nothing");
}

}  // namespace

std::string methodWord(const tracking::EstimatorOptions& options) {
  if (options.mode == tracking::Mode::kTracks)
    return "track";
  return methodNames()[static_cast<std::size_t>(options.instant.triangulation.method)];
}

std::vector<std::string> TrackingParameters::allLabels() const {
  std::vector<std::string> all = labels;
  if (identity.codes) {
    for (const identity::BlinkCode& code : identity.codes->codes)
      all.push_back(code.label);
  }
  return all;
}

std::string describeIdentity(const TrackingParameters& parameters) {
  if (!parameters.identity.codes)
    return "";
  const identity::BlinkCodes& codes = *parameters.identity.codes;
  const tracking::TrackerOptions& tracks = parameters.estimator.tracks;
  std::ostringstream text;
  text << codes.codes.size() << " LEDs are told by how they blink; since they may be dark for "
       << codes.longestDark() << " s, the tracker uses tracks/prediction_time "
       << tracks.prediction_time << " s and tracks/detection_probability "
       << tracks.detection_probability;
  return text.str();
}

TrackingParameters TrackingParameters::read(ParameterReader reader) {
  TrackingParameters p;
  p.labels = checkedLabels(reader.nameOf("labels"), reader.optional("labels", p.labels));
  tracking::EstimatorOptions& estimator = p.estimator;
  const bool tracks = estimator.mode == tracking::Mode::kTracks;
  const std::string mode =
      reader.choice("mode", tracks ? "tracks" : "instant", {"tracks", "instant"});
  estimator.mode = mode == "tracks" ? tracking::Mode::kTracks : tracking::Mode::kInstant;
  const double pixel_stddev =
      reader.bounded("pixel_stddev", estimator.tracks.pixel_stddev, 0.001, 100.0);
  estimator.tracks.pixel_stddev = pixel_stddev;
  estimator.instant.triangulation.pixel_stddev = pixel_stddev;
  readTracks(&reader, &estimator.tracks);
  readMotion(&reader, &estimator.tracks.motion);
  readInstant(&reader, &estimator.instant);
  readIdentity(&reader, &p);
  p.bodies = BodyParameters::read(&reader, estimator.tracks, p.allLabels());
  readOutput(&reader, estimator.mode, &p.output);

  p.zones.hysteresis = reader.bounded("zones/hysteresis", p.zones.hysteresis, 0.0, 10.0);
  p.zones.timeout = reader.bounded("zones/timeout", p.zones.timeout, 0.01, 60.0);
  p.trigger.maximum_gap = reader.bounded("trigger/maximum_gap", p.trigger.maximum_gap, 0.001, 10.0);
  p.trigger.history = reader.bounded("trigger/history", p.trigger.history, 0.01, 60.0);

  p.markers.rate = reader.bounded("markers/rate", p.markers.rate, 0.1, 100.0);
  p.markers.image_plane_distance =
      reader.bounded("markers/image_plane_distance", p.markers.image_plane_distance, 0.01, 10.0);
  p.markers.trail_duration =
      reader.bounded("markers/trail_duration", p.markers.trail_duration, 0.0, 600.0);
  p.clock_tolerance = reader.bounded("clock_tolerance", p.clock_tolerance, 0.001, 10.0);

  reader.bounded("diagnostic_period", 1.0, 0.1, 3600.0);  // of diagnostic_updater, which reads it
  reader.refuseUnknown();
  return p;
}

}  // namespace wiimote_tracker
