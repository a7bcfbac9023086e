// Recomputes the points of a recording with the code of the node, as fast as possible.

#include "output.h"
#include "recording.h"
#include "ros/message_tracker.h"
#include "wiimote_tracker_triangulation/geometry/rig_file.h"
#include "wiimote_tracker_triangulation/ros/conversions.h"
#include "wiimote_tracker_triangulation/ros/parameter_file.h"

#include <wiimote_tracker_msgs/parameter_reader.h>
#include <CLI/CLI.hpp>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>

namespace {

using namespace wiimote_tracker;
using wiimote_tracker_msgs::IrBlobArray;
using wiimote_tracker_msgs::RigCalibration;

struct Arguments {
  std::string input;
  OutputFiles output;
  std::string mode;        // empty: as the parameters say
  std::string parameters;  // file; empty: the defaults
  std::string rig;         // file; empty: as recorded
  std::string name_space;  // empty: that of the rig
  bool results_only = false;
};

/// Feeds recorded rigs, triggers and images to the tracker.
class Player {
 public:
  Player(const TrackingParameters& parameters, const Topics& topics, Output* output)
      : tracker_(parameters, output), topics_(topics), output_(output) {}

  /// Reports a rig that cannot be used; the previous one stays.
  void play(const RigCalibration& rig) {
    try {
      tracker_.takeRig(rig);
    } catch (const geometry::Error& e) {
      refusal_ = e.what();
      const std::string rest = tracker_.hasRig() ? ", the one before stays in use: " : ": ";
      output_->onProblem("a rig is refused" + rest + refusal_);
      return;
    }
    cameras_.clear();
    for (const geometry::RigCamera& camera : tracker_.rig().cameras)
      cameras_[topics_.blobs(camera.camera.name)] = camera.camera.name;
  }

  void play(const rosbag::MessageInstance& message) {
    output_->setTime(message.getTime());
    const std::string& topic = message.getTopic();
    if (topic == topics_.rig()) {
      if (const auto rig = read<RigCalibration>(message))
        play(*rig);
    } else if (topic == topics_.trigger()) {
      if (const auto trigger = read<std_msgs::Header>(message))
        tracker_.takeTrigger(*trigger);
    } else if (const auto camera = cameras_.find(topic); camera != cameras_.end()) {
      if (const auto image = read<IrBlobArray>(message)) {
        tracker_.takeImage(camera->second, *image);
        ++images_used_;
      }
    }
  }

  /// @throws BagError: the tracker got no rig or no image.
  void finish() {
    if (!tracker_.hasRig())
      throw BagError(refusal_.empty()
                         ? "no rig is on " + topics_.rig() + ": say where with --namespace"
                         : "no rig can be used, name another one with --rig: " + refusal_);
    if (images_used_ == 0)
      throw BagError("no image is of a camera of the rig, such as on " + topics_.blobs("CAMERA") +
                     ": name its rig with --rig, or the topics' namespace with --namespace");
    tracker_.finish();
  }

  const tracking::Counters& counters() const { return tracker_.counters(); }

 private:
  MessageTracker tracker_;
  Topics topics_;
  Output* output_;
  std::map<std::string, std::string> cameras_;  // by image topic
  std::size_t images_used_ = 0;
  std::string refusal_;  // of the last rig that was refused
};

TrackingParameters parametersOf(const Arguments& arguments) {
  ParameterTree tree = readParameterTree(arguments.parameters);
  if (!arguments.mode.empty())
    tree.set("mode", arguments.mode);
  return TrackingParameters::read(ParameterReader(tree));
}

/// Excludes results of an earlier tracker: the LEDs and bodies in the bag and in the parameters.
void leaveOutEarlierResults(const Recording& recording,
                            const Topics& topics,
                            const TrackingParameters& parameters,
                            Output* output) {
  std::set<std::string> labels = recording.labels(topics.points());
  for (const std::string& label : parameters.allLabels())
    labels.insert(label);
  std::set<std::string> bodies = recording.bodies(topics.bodies());
  for (const body::Constellation& body : parameters.bodies.known)
    bodies.insert(body.name);
  output->leaveOut(labels, bodies);
}

void printSummary(const Recording& recording,
                  const Output& output,
                  const tracking::Counters& counters,
                  double seconds) {
  const auto count = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
  const auto images = static_cast<double>(recording.images());
  std::printf(
      "%zu images (%.0f per second), %llu outputs, %llu LEDs, %llu triggers answered, "
      "%llu zone events.\n",
      recording.images(), images / seconds, count(output.points()), count(output.leds()),
      count(output.triggersAnswered()), count(output.zoneEvents()));
  std::printf("Images that were late: %llu, too late to be used: %llu, repeated: %llu.\n",
              count(counters.late), count(counters.dropped), count(counters.repeated));
}

void run(const Arguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  std::error_code ignored;
  if (arguments.input == arguments.output.bag ||
      std::filesystem::equivalent(arguments.input, arguments.output.bag, ignored))
    throw BagError("both bags are " + arguments.input + ": write to another one");
  const TrackingParameters parameters = parametersOf(arguments);
  if (parameters.identity.codes)
    std::printf("%s.\n", describeIdentity(parameters).c_str());
  const Recording recording(arguments.input);
  if (recording.images() == 0)
    throw BagError(arguments.input + " holds no images: record the cameras' ir_blobs");
  const Topics topics =
      arguments.name_space.empty() ? recording.topics() : Topics(arguments.name_space);
  const bool has_own_rig = !arguments.rig.empty();
  if (!has_own_rig && !recording.holdsRig())
    throw BagError(arguments.input + " holds no rig: name a saved one with --rig");

  Output output(arguments.output, topics, parameters.output.publish_predicted);
  leaveOutEarlierResults(recording, topics, parameters, &output);
  Player player(parameters, topics, &output);
  if (has_own_rig) {
    const RigCalibration rig = toMessage(geometry::readRigFile(arguments.rig));
    output.setTime(recording.justBefore());
    output.writeRig(rig, recording.justBefore());
    player.play(rig);
  }
  for (std::size_t i = 0; i < recording.size(); ++i) {
    const rosbag::MessageInstance& message = recording[i];
    if (has_own_rig && message.getTopic() == topics.rig())
      continue;
    if (!arguments.results_only)
      output.copy(message);
    player.play(message);
  }
  player.finish();
  output.finish();
  const std::chrono::duration<double> duration = std::chrono::steady_clock::now() - start;
  printSummary(recording, output, player.counters(), duration.count());
}

/// Reads options into `arguments`; omitted ones keep their values.
void addOptions(CLI::App* app, Arguments* arguments) {
  app->get_formatter()->label("Usage", "usage");
  app->add_option("IN.bag", arguments->input, "recording to read")->required();
  app->add_option("OUT.bag", arguments->output.bag,
                  "bag to write: the recording without earlier results, and the new "
                  "points, transforms, zone events and points at triggers")
      ->required();
  app->add_option("--mode", arguments->mode, "tracks or instant, instead of the parameters' mode");
  app->add_option("--params", arguments->parameters,
                  "YAML with the node's parameters; default: those of config/triangulation.yaml");
  app->add_option("--rig", arguments->rig, "rig.yaml to use instead of the rigs in the bag");
  app->add_option("--csv", arguments->output.csv, "also write the points as CSV");
  app->add_option("--mat", arguments->output.matlab, "also write the points as a MATLAB file");
  app->add_option("--namespace", arguments->name_space,
                  "of the tracker's topics; default: that of the rig in the bag");
  app->add_flag("--results-only", arguments->results_only,
                "leave the recording itself out of OUT.bag");
  app->add_option_function<unsigned>(
         "--threads", [](const unsigned&) {}, "has no effect: one thread does all the work")
      ->check(CLI::Range(1, 999));
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app(
      "Computes the points of a recording from its images and its rig, as the node would have "
      "done with nothing delayed on the way.",
      "track_bag");
  addOptions(&app, &arguments);
  try {
    app.parse(argc, argv);
    run(arguments);
    return 0;
  } catch (const CLI::Success& e) {  // --help
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    std::fprintf(stderr, "track_bag: %s\n%s", e.what(), app.help().c_str());
    return 2;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "track_bag: %s\n", e.what());
    return 1;
  }
}
