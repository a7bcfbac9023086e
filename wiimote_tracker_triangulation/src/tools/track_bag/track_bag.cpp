// Recomputes the points of a recording with the code of the node, as fast as possible.

#include "geometry/output_file.h"
#include "output.h"
#include "recording.h"
#include "ros/tracker/message_tracker.h"
#include "smoothed_tracks.h"
#include "wiimote_tracker_triangulation/geometry/rig_file.h"
#include "wiimote_tracker_triangulation/ros/conversions.h"
#include "wiimote_tracker_triangulation/ros/parameter_file.h"

#include <wiimote_tracker_msgs/TrackedBodyArray.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>
#include <wiimote_tracker_msgs/argument_parser.h>
#include <wiimote_tracker_msgs/interruption.h>
#include <wiimote_tracker_msgs/parameter_reader.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace wiimote_tracker;
using wiimote_tracker_msgs::IrBlobArray;
using wiimote_tracker_msgs::RigCalibration;

struct Arguments {
  std::string input;
  std::string output;
  measurements::OutputNames measurements;
  std::string mode;        // empty: as the parameters say
  std::string parameters;  // file; empty: the defaults
  std::string rig;         // file; empty: as recorded
  std::string bodies;      // file; empty: as the parameters say
  std::string name_space;  // empty: that of the rig
  bool results_only = false;
  bool smooth = false;
};

/// Feeds recorded rigs, triggers, images and samples of IMUs to the tracker.
class Player {
 public:
  Player(const TrackingParameters& parameters,
         const Topics& topics,
         MessageSink* sink,
         SnapshotFilter* filter)
      : tracker_(parameters, sink, filter), topics_(topics), sink_(sink) {
    for (const body::Constellation& body : parameters.bodies.known) {
      if (body.imu)
        imus_.emplace(topics_(body.imu->topic), body.name);
    }
  }

  /// Plays a whole recording. @param own_rig replaces the recorded ones, if there is one.
  /// @param before called with each message before it is played.
  /// @throws BagError: the tracker got no rig or could use no image. Interrupted.
  void play(const Recording& recording,
            const std::optional<RigCalibration>& own_rig,
            const std::function<void(const rosbag::MessageInstance&)>& before) {
    if (own_rig)
      play(*own_rig);
    for (std::size_t i = 0; i < recording.size(); ++i) {
      const rosbag::MessageInstance& message = recording[i];
      if (own_rig && message.getTopic() == topics_("calibration/rig"))
        continue;
      throwIfInterrupted();
      before(message);
      play(message);
    }
    finish(recording);
  }

  const tracking::Counters& counters() const { return tracker_.counters(); }

  /// Of the rigs' cameras.
  std::size_t images() const { return images_ + before_rig_; }

  /// Those of them that came before the first rig: they give no points.
  std::size_t imagesBeforeRig() const { return before_rig_; }

 private:
  /// Reports a rig that cannot be used; the previous one stays.
  void play(const RigCalibration& rig) {
    try {
      tracker_.takeRig(rig);
    } catch (const geometry::Error& e) {
      refusal_ = e.what();
      const std::string rest = tracker_.hasRig() ? ", the one before stays in use: " : ": ";
      sink_->onProblem("a rig is refused" + rest + refusal_);
      return;
    }
    cameras_.clear();
    for (const geometry::RigCamera& camera : tracker_.rig().cameras)
      cameras_[topics_(camera.camera.name + "/ir_blobs")] = camera.camera.name;
    for (const auto& [topic, images] : early_images_)
      before_rig_ += cameras_.count(topic) > 0 ? images : 0;
    early_images_.clear();
  }

  void play(const rosbag::MessageInstance& message) {
    const std::string& topic = message.getTopic();
    if (topic == topics_("calibration/rig")) {
      if (const auto rig = read<RigCalibration>(message))
        play(*rig);
    } else if (topic == topics_("trigger")) {
      if (const auto trigger = read<std_msgs::Header>(message))
        tracker_.takeTrigger(*trigger);
    } else if (const auto camera = cameras_.find(topic); camera != cameras_.end()) {
      if (const auto image = read<IrBlobArray>(message)) {
        any_usable_ |= tracker_.takeImage(camera->second, *image);
        ++images_;
      }
    } else if (const auto bodies = imus_.equal_range(topic); bodies.first != bodies.second) {
      if (const auto imu = read<sensor_msgs::Imu>(message)) {
        for (auto body = bodies.first; body != bodies.second; ++body)
          tracker_.takeInertial(body->second, *imu);
      }
    } else if (!tracker_.hasRig() && read<IrBlobArray>(message)) {
      ++early_images_[topic];
    }
  }

  void finish(const Recording& recording) {
    if (!tracker_.hasRig())
      throw BagError(refusal_.empty()
                         ? "no rig is on " + topics_("calibration/rig") + ", but on " +
                               joined(recording.rigTopics()) +
                               ": name the namespace before /calibration with --namespace"
                         : "no rig can be used, name another one with --rig: " + refusal_);
    if (images_ == 0 && before_rig_ > 0)
      throw BagError("the rig comes after all images of its cameras: name a rig with --rig");
    if (images_ == 0)
      throw BagError("no image is of a camera of the rig, such as on " +
                     topics_("CAMERA/ir_blobs") +
                     ": name its rig with --rig, or the topics' namespace with --namespace");
    if (!any_usable_)
      throw BagError(
          "no image could be used, as said above: name the rig of its cameras with "
          "--rig");
    tracker_.finish();
  }

  MessageTracker tracker_;
  Topics topics_;
  MessageSink* sink_;
  std::map<std::string, std::string> cameras_;    // by image topic
  std::multimap<std::string, std::string> imus_;  // bodies by their IMU's topic
  std::size_t images_ = 0;
  bool any_usable_ = false;
  std::map<std::string, std::size_t> early_images_;  // before the first rig, by topic
  std::size_t before_rig_ = 0;
  std::string refusal_;  // of the last rig that was refused
};

/// @throws Error: a file to write is also to be read, or to be written as something else.
void checkFiles(const Arguments& arguments, const BodyParameters& bodies) {
  std::vector<std::string> to_write = arguments.measurements.tables();
  to_write.push_back(arguments.output);
  const std::string& folder = arguments.measurements.tum;
  for (const body::Constellation& body : bodies.known) {
    if (!folder.empty())
      to_write.push_back(measurements::tumPath(folder, body.name));
  }
  geometry::checkDistinct(to_write,
                          {arguments.input, arguments.parameters, arguments.rig, bodies.file});
}

TrackingParameters parametersOf(const Arguments& arguments) {
  ParameterTree tree = readParameterTree(arguments.parameters, "triangulation");
  if (!arguments.mode.empty())
    tree.set("mode", arguments.mode);
  if (!arguments.bodies.empty()) {
    std::error_code ignored;
    if (!std::filesystem::exists(arguments.bodies, ignored))
      throw BagError("there is no file " + arguments.bodies + ": correct --bodies");
    tree.set("bodies/file", arguments.bodies);
  }
  return TrackingParameters::read(ParameterReader(tree));
}

/// Excludes results of an earlier tracker: the LEDs and bodies in the bag and in the parameters.
void dropRecordedResults(const Recording& recording,
                         const Topics& topics,
                         const TrackingParameters& parameters,
                         Output* output) {
  std::set<std::string> labels, bodies;
  recording.forEach<wiimote_tracker_msgs::TrackedPointArray>(topics("points"), [&](auto& message) {
    for (const auto& point : message.points)
      labels.insert(point.label);
  });
  recording.forEach<wiimote_tracker_msgs::TrackedBodyArray>(topics("bodies"), [&](auto& message) {
    for (const auto& body : message.bodies)
      bodies.insert(body.name);
  });
  const std::vector<std::string> named = parameters.allLabels();
  const auto renamed = std::find_if(labels.begin(), labels.end(), [&](const std::string& label) {
    return std::count(named.begin(), named.end(), label) == 0 && label.rfind("led_", 0) != 0;
  });
  if (renamed != labels.end())
    std::fprintf(stderr,
                 "The recorded tracker had an LED '%s', which gets another name now: give its "
                 "labels with --params.\n",
                 renamed->c_str());
  labels.insert(named.begin(), named.end());
  if (parameters.bodies.known.empty() && !bodies.empty())
    std::fprintf(stderr,
                 "The recorded tracker had a body '%s', whose LEDs are single ones now: name the "
                 "file of bodies with --bodies.\n",
                 bodies.begin()->c_str());
  for (const body::Constellation& body : parameters.bodies.known)
    bodies.insert(body.name);
  output->dropRecorded(labels, bodies);
}

/// @throws BagError: the outputs are not of the images' times.
void checkForSmoothing(const TrackingParameters& parameters) {
  if (parameters.estimator.tracker_mode != estimators::TrackerMode::kTracks)
    throw BagError("--smooth needs tracks: set mode to tracks");
  if (parameters.output.predict_to_now)
    throw BagError("--smooth cannot predict: set output/predict_to_now to false");
}

void printSummary(const Output& output, const Player& player, double seconds) {
  const auto count = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
  const auto images = static_cast<double>(player.images());
  std::printf(
      "Images: %zu (%.0f per second), outputs: %llu, LEDs: %llu, triggers answered: %llu, "
      "zone events: %llu.\n",
      player.images(), images / seconds, count(output.points()), count(output.leds()),
      count(output.triggersAnswered()), count(output.zoneEvents()));
  std::printf(
      "Images out of the order of their exposures (normal): %llu, not used since too late or by a "
      "wrong clock: %llu, repeated: %llu.\n",
      count(player.counters().late), count(player.counters().dropped),
      count(player.counters().repeated));
  if (player.imagesBeforeRig() > 0)
    std::printf("Images before the first rig, without points: %zu; name a rig with --rig.\n",
                player.imagesBeforeRig());
}

void run(const Arguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  const TrackingParameters parameters = parametersOf(arguments);
  checkFiles(arguments, parameters.bodies);
  if (arguments.smooth)
    checkForSmoothing(parameters);
  if (parameters.identity.codes)
    std::printf("%s.\n", describeIdentity(parameters).c_str());
  const std::string missing_bodies = describeMissingFile(parameters.bodies.file);
  if (!missing_bodies.empty())
    std::fprintf(stderr, "%s.\n", missing_bodies.c_str());
  measurements::OutputNames names = arguments.measurements;
  if (!names.tum.empty() && parameters.bodies.known.empty()) {
    std::fprintf(stderr, "--tum writes nothing without bodies: name their file with --bodies.\n");
    names.tum.clear();
  }
  if (names.rate != measurements::OutputNames().rate && names.c3d.empty() && names.trc.empty())
    std::fprintf(stderr, "--rate changes nothing without --c3d or --trc.\n");
  const Recording recording(arguments.input);
  if (recording.images() == 0)
    throw BagError(arguments.input + " holds no images: record the cameras' ir_blobs");
  if (!recording.mixedTimes().empty())
    std::fprintf(stderr, "track_bag: %s\n", recording.mixedTimes().c_str());
  const Topics topics =
      arguments.name_space.empty() ? recording.topics() : Topics(arguments.name_space);
  const bool has_own_rig = !arguments.rig.empty();
  if (!has_own_rig && recording.rigTopics().empty())
    throw BagError(arguments.input + " holds no rig: name a saved one with --rig");

  std::optional<RigCalibration> own_rig;
  if (has_own_rig)
    own_rig = toMessage(geometry::readRigFile(arguments.rig));

  deferInterruption();  // so that no parts of files are left
  SmoothedTracks smoothed(parameters.estimator.tracks);
  SnapshotFilter* const filter = arguments.smooth ? &smoothed : nullptr;
  Output output(arguments.output, names, topics, parameters.output);
  dropRecordedResults(recording, topics, parameters, &output);
  if (arguments.smooth) {
    MessageSink ignored;
    Player(parameters, topics, &ignored, filter).play(recording, own_rig, [](const auto&) {});
    smoothed.smooth();
  }
  if (own_rig) {
    output.setTime(recording.justBefore());
    output.writeRig(*own_rig, recording.justBefore());
  }
  const auto copy = [&](const rosbag::MessageInstance& message) {
    if (!arguments.results_only)
      output.copy(message);
    output.setTime(message.getTime());
  };
  Player player(parameters, topics, &output, filter);
  player.play(recording, own_rig, copy);
  output.finish();
  const std::chrono::duration<double> duration = std::chrono::steady_clock::now() - start;
  printSummary(output, player, duration.count());
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  ArgumentParser parser("track_bag",
                        "Computes the points of a recording from its images and its rig, as the "
                        "node would have\ndone with nothing delayed on the way. OUT.bag gets the "
                        "recording without earlier results,\nand the new points, "
                        "transforms, zone events and points at triggers.");
  parser.positional("IN.bag", &arguments.input);
  parser.positional("OUT.bag", &arguments.output);
  parser.option("--mode MODE", &arguments.mode, {"tracks", "instant"},
                "instead of the parameters' mode");
  parser.option("--params FILE", &arguments.parameters,
                "YAML with the node's parameters, or with a group triangulation of them, as for "
                "parameters:= of tracker.launch; default: those of config/triangulation.yaml");
  parser.option("--rig FILE", &arguments.rig, "rig.yaml to use instead of the rigs in the bag");
  parser.option("--bodies FILE", &arguments.bodies,
                "rigid bodies to track, instead of the parameters' bodies/file");
  measurements::OutputNames& names = arguments.measurements;
  parser.option(
      "--csv FILE", &names.csv,
      "also write the points as CSV, and poses of bodies beside NAME.csv as NAME_bodies.csv");
  parser.option("--mat FILE", &names.matlab, "also write points and bodies as a MATLAB file");
  parser.option("--c3d FILE", &names.c3d, "also write the tracked LEDs, also of bodies, as C3D");
  parser.option("--trc FILE", &names.trc, "the same as TRC");
  parser.option("--rate HZ", &names.rate, 1.0, 1000.0, "of C3D and TRC [Hz]");
  parser.option("--tum FOLDER", &names.tum,
                "also write the poses of bodies as FOLDER/<body>.tum, for evo");
  parser.option("--namespace NAME", &arguments.name_space,
                "of the tracker's topics; default: that of the rig in the bag");
  parser.flag("--results-only", &arguments.results_only,
              "leave the recording itself out of OUT.bag");
  parser.flag("--smooth", &arguments.smooth, "smooth the points with what was seen later");
  return parser.run(argc, argv, [&] {
    run(arguments);
    return 0;
  });
}
