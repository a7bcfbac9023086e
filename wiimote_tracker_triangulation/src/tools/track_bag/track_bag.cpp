// Computes the points of a recording again, with the code of the node, as fast as the machine
// allows.

#include "arguments.h"
#include "bag_tracker.h"
#include "earlier_results.h"
#include "error.h"
#include "input_bag.h"
#include "parameter_file.h"
#include "recorded_message.h"
#include "results.h"
#include "wiimote_tracker_triangulation/geometry/rig_file.h"
#include "wiimote_tracker_triangulation/ros/conversions.h"
#include "worker.h"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <thread>

namespace {

using namespace wiimote_tracker;
using wiimote_tracker_msgs::IrBlobArray;
using wiimote_tracker_msgs::RigCalibration;

/// A message on its way from the recording to the tracker and the results.
struct Item {
  std::string topic;
  ros::Time recorded;
  std::shared_ptr<const MessageBytes> copy;  // what goes into the new bag as it is; null: nothing
  boost::shared_ptr<ros::M_string> header;   // of its connection
  std::shared_ptr<const IrBlobArray> image;  // at most one of these
  std::shared_ptr<const RigCalibration> rig;
  std::shared_ptr<const std_msgs::Header> trigger;
};

void handle(const Item& item, BagTracker* tracker, Results* results) {
  if (item.copy)
    results->copy(item.topic, item.recorded, item.copy, item.header);
  if (item.rig)
    tracker->takeRig(*item.rig, item.recorded);
  if (item.trigger)
    tracker->takeTrigger(*item.trigger, item.recorded);
  if (item.image)
    tracker->takeImage(item.topic, *item.image, item.recorded);
}

void checkPaths(const Arguments& arguments) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (arguments.input == arguments.output ||
      fs::equivalent(arguments.input, arguments.output, ignored))
    throw BagError("both bags are " + arguments.input + ": write to another one");
}

std::set<std::string> labelsOf(const InputBag& input,
                               const Topics& topics,
                               const TrackingParameters& parameters) {
  std::set<std::string> labels = input.recordedLabels(topics.points());
  const std::vector<std::string> own = parameters.allLabels();
  labels.insert(own.begin(), own.end());
  return labels;
}

std::set<std::string> bodiesOf(const InputBag& input,
                               const Topics& topics,
                               const TrackingParameters& parameters) {
  std::set<std::string> names = input.recordedBodies(topics.bodies());
  for (const body::Constellation& body : parameters.bodies.known)
    names.insert(body.name);
  return names;
}

void run(const Arguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  checkPaths(arguments);
  const TrackingParameters parameters = readParameterFile(arguments.parameters, arguments.mode);
  if (parameters.identity.codes)
    std::printf("%s.\n", describeIdentity(parameters).c_str());
  const InputBag input(arguments.input);
  if (input.images() == 0)
    throw BagError(arguments.input + " holds no images: record the cameras' ir_blobs");
  const Topics topics = arguments.name_space ? Topics(*arguments.name_space) : input.topics();
  const bool has_own_rig = !arguments.rig.empty();
  if (!has_own_rig && !input.holdsRig())
    throw BagError(arguments.input + " holds no rig: name a saved one with --rig");

  const unsigned threads =
      arguments.threads > 0 ? arguments.threads : std::thread::hardware_concurrency();
  ResultFiles files;
  files.bag = arguments.output;
  files.csv = arguments.csv;
  files.matlab = arguments.matlab;
  files.publish_predicted = parameters.output.publish_predicted;
  Results results(files, topics, threads > 1);
  BagTracker tracker(parameters, topics, &results);
  Worker worker(threads > 2);

  if (has_own_rig) {
    const RigCalibration rig = toMessage(geometry::readRigFile(arguments.rig));
    results.addRig(rig, input.justBefore());
    tracker.takeRig(rig, input.justBefore());
  }
  const EarlierResults earlier(topics, labelsOf(input, topics, parameters),
                               bodiesOf(input, topics, parameters));
  for (std::size_t i = 0; i < input.size(); ++i) {
    const rosbag::MessageInstance& message = input[i];
    Item item;
    item.topic = message.getTopic();
    item.recorded = message.getTime();
    item.header = message.getConnectionHeader();
    const bool is_rig = item.topic == topics.rig();
    if (is_rig && has_own_rig)
      continue;
    if (is_rig)
      item.rig = read<RigCalibration>(message);
    else if (item.topic == topics.trigger())
      item.trigger = read<std_msgs::Header>(message);
    else
      item.image = read<IrBlobArray>(message);
    if (!arguments.results_only) {
      if (auto rest = earlier.rest(message))
        item.copy = std::make_shared<const MessageBytes>(std::move(*rest));
    }
    worker.give([item = std::move(item), &tracker, &results] { handle(item, &tracker, &results); });
  }
  worker.finish();
  if (!tracker.hasRig())
    throw BagError(tracker.refusal().empty()
                       ? "no rig is on " + topics.rig() + ": say where with --namespace"
                       : "no rig can be used, name another one with --rig: " + tracker.refusal());
  tracker.finish();
  if (tracker.imagesUsed() == 0)
    throw BagError("no image is of a camera of the rig, such as on " + topics.blobs("CAMERA") +
                   ": name its rig with --rig, or the topics' namespace with --namespace");
  results.finish();

  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const tracking::Counters& counters = tracker.counters();
  std::printf(
      "%zu images (%.0f per second), %llu outputs, %llu LEDs, %llu triggers answered, "
      "%llu zone events.\n",
      input.images(), static_cast<double>(input.images()) / seconds,
      static_cast<unsigned long long>(results.points()),
      static_cast<unsigned long long>(results.leds()),
      static_cast<unsigned long long>(results.triggersAnswered()),
      static_cast<unsigned long long>(results.zoneEvents()));
  std::printf("Images that were late: %llu, too late to be used: %llu, repeated: %llu.\n",
              static_cast<unsigned long long>(counters.late),
              static_cast<unsigned long long>(counters.dropped),
              static_cast<unsigned long long>(counters.repeated));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const wiimote_tracker::Arguments arguments = wiimote_tracker::readArguments(argc, argv);
    if (arguments.wants_help)
      std::printf("%s", wiimote_tracker::kUsage);
    else
      run(arguments);
    return 0;
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "track_bag: %s\n%s", error.what(), wiimote_tracker::kUsage);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "track_bag: %s\n", error.what());
    return 1;
  }
}
