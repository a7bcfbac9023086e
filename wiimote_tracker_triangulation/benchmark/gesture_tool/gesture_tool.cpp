// Accuracy of gesture recognition on recordings of people.

#include "evaluate.h"
#include "report.h"

#include <wiimote_tracker_msgs/argument_parser.h>

#include <cstdio>
#include <optional>
#include <string>

using namespace wiimote_tracker;

int main(int argc, char** argv) {
  std::string command, train, test, motion, json;
  std::size_t examples = 0;  // 0: all
  gesture::RecognizerOptions options;
  // The files mark where gestures begin and end, and their unit of length is their own.
  options.shape.minimum_length = 0.0;
  ArgumentParser parser(
      "gesture_tool",
      "Tests how well gestures are recognised. DIR holds a folder per person, and in it a CSV\n"
      "file per gesture, named after its class, with rows `x y z t_ms`. A person who is in both\n"
      "folders is never tested with examples of his own, so that the same DIR twice leaves one\n"
      "person out at a time. Prints accuracy, confusion matrix, and two published methods on the\n"
      "same data.");
  parser.positional("evaluate", &command);
  parser.option("--train DIR", &train, "examples; needed");
  parser.option("--test DIR", &test, "gestures to recognise; needed");
  parser.option("--examples N", &examples, 1, 1000000,
                "of each gesture, by as many people; default: of all people");
  parser.option("--motion FILE", &motion,
                "motion that is no gesture, CSV with a header line, time [s] in the first column, "
                "then x, y, z [mm] of any number of markers: counts the false alarms per minute of "
                "continuous spotting");
  parser.flag("--any-heading", &options.any_heading,
              "the same gesture in another direction about z is the same");
  parser.option("--rejection-distance D", &options.rejection_distance, 1e-9, 1e6,
                "beyond which a path is no gesture, see config/gestures.yaml");
  parser.option("--json FILE", &json, "write all of it: accuracy, confusion, ...");
  return parser.run(argc, argv, [&] {
    if (command != "evaluate")
      throw BadArguments("the first word must be evaluate");
    if (train.empty() || test.empty())
      throw BadArguments("--train and --test are needed");
    const auto teachers = gesture_tool::readPeople(train);
    const auto evaluation =
        gesture_tool::evaluate(teachers, gesture_tool::readPeople(test), examples, options);
    std::optional<gesture_tool::FalseAlarms> alarms;
    if (!motion.empty())
      alarms = gesture_tool::countFalseAlarms(teachers, motion, options);
    std::fputs(gesture_tool::table(evaluation, alarms).c_str(), stdout);
    if (!json.empty())
      gesture_tool::writeJson(json, evaluation, alarms);
    return 0;
  });
}
