// Accuracy of gesture recognition on recordings of people.

#include "evaluate.h"
#include "false_alarms.h"
#include "report.h"
#include "wiimote_tracker_triangulation/geometry/error.h"

#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace {

using namespace wiimote_tracker;

const char* const kUsage =
    "usage: gesture_tool evaluate --train DIR --test DIR [--examples N] [--motion FILE]\n"
    "                             [--any-heading] [--rejection-distance D] [--json FILE]\n"
    "Tests how well gestures are recognised. DIR holds a folder per person, and in it a CSV file\n"
    "per gesture, named after its class, with rows `x y z t_ms`. A person who is in both folders\n"
    "is never tested with examples of his own, so that the same DIR twice leaves one person out "
    "at\n"
    "a time. Prints accuracy, confusion matrix, and two published methods on the same data.\n"
    "  --examples N            of each gesture, by as many people; default: of all people\n"
    "  --motion FILE           motion that is no gesture, CSV with a header line, time [s] in the\n"
    "                          first column, then x, y, z [mm] of any number of markers: counts\n"
    "                          the false alarms per minute of continuous spotting\n"
    "  --any-heading           the same gesture in another direction about z is the same\n"
    "  --rejection-distance D  beyond which a path is no gesture, see config/gestures.yaml\n"
    "  --json FILE             writes all of it: accuracy, confusion, ...\n";

struct Arguments {
  std::string train, test, motion, json;
  std::size_t examples = 0;
  gesture::RecognizerOptions options;
};

double positive(const std::string& option, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(value > 0.0) || value > 1e6)
    throw std::invalid_argument(option + " is '" + text + "', but must be a number above 0");
  return value;
}

Arguments argumentsOf(int argc, char** argv) {
  Arguments arguments;
  // The files mark where gestures begin and end, and their unit of length is their own.
  arguments.options.shape.minimum_length = 0.0;
  for (int i = 2; i < argc; ++i) {
    const std::string option = argv[i];
    const auto value = [&] {
      if (i + 1 == argc)
        throw std::invalid_argument(option + " needs a value");
      return std::string(argv[++i]);
    };
    if (option == "--train")
      arguments.train = value();
    else if (option == "--test")
      arguments.test = value();
    else if (option == "--motion")
      arguments.motion = value();
    else if (option == "--json")
      arguments.json = value();
    else if (option == "--examples")
      arguments.examples = static_cast<std::size_t>(positive(option, value()));
    else if (option == "--rejection-distance")
      arguments.options.rejection_distance = positive(option, value());
    else if (option == "--any-heading")
      arguments.options.any_heading = true;
    else
      throw std::invalid_argument("unknown option " + option);
  }
  if (arguments.train.empty() || arguments.test.empty())
    throw std::invalid_argument("--train and --test are needed");
  return arguments;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string command = argc > 1 ? argv[1] : "";
  if (command == "-h" || command == "--help") {
    std::fputs(kUsage, stdout);
    return 0;
  }
  try {
    if (command != "evaluate")
      throw std::invalid_argument("the first word must be evaluate");
    const Arguments arguments = argumentsOf(argc, argv);
    const auto train = gesture_tool::readPeople(arguments.train);
    const auto test = gesture_tool::readPeople(arguments.test);
    const gesture_tool::Evaluation evaluation =
        gesture_tool::evaluate(train, test, arguments.examples, arguments.options);
    std::optional<gesture_tool::FalseAlarms> alarms;
    if (!arguments.motion.empty())
      alarms = gesture_tool::countFalseAlarms(train, arguments.motion, arguments.options);
    std::fputs(gesture_tool::table(evaluation, alarms).c_str(), stdout);
    if (!arguments.json.empty())
      gesture_tool::writeJson(arguments.json, evaluation, alarms);
    return 0;
  } catch (const std::invalid_argument& e) {
    std::fprintf(stderr, "gesture_tool: %s.\n%s", e.what(), kUsage);
    return 2;
  } catch (const geometry::Error& e) {
    std::fprintf(stderr, "gesture_tool: %s.\n", e.what());
    return 1;
  }
}
