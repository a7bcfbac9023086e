// Tables and Arduino sketches for LEDs that are identified by blink codes.

#include "listing.h"
#include "wiimote_tracker_triangulation/identity/codes_file.h"

#include <wiimote_tracker_msgs/argument_parser.h>

#include <cstdio>
#include <string>
#include <vector>

namespace {

using namespace wiimote_tracker;

struct Arguments {
  std::string command;
  std::vector<std::string> words;
  double period = 0.0;  // [s]; 0: the file's
  double chip = 0.023;  // [s]
  double tolerance = 0.01;
};

/// The period for driving the LEDs [s].
double periodOf(const identity::BlinkCodes& codes, double wanted) {
  // A file of cyclic codes has one nominal period and a tolerance.
  if (wanted == 0.0)
    return codes.synchronous ? codes.shortest_period
                             : 0.5 * (codes.shortest_period + codes.longest_period);
  if (wanted < codes.shortest_period * (1.0 - 1e-9) || wanted > codes.longest_period * (1.0 + 1e-9))
    throw BadArguments(format("--period must be from %g to %g s, the range of the file",
                              codes.shortest_period, codes.longest_period));
  return wanted;
}

/// @throws BadArguments: an option that the command does not use.
void refuseUnused(const Arguments& arguments) {
  const Arguments defaults;
  const bool chooses = arguments.command == "choose";
  const bool drives = arguments.command == "table" || arguments.command == "sketch";
  if (!drives && arguments.period != defaults.period)
    throw BadArguments("--period is for table and sketch: leave it out");
  if (!chooses && (arguments.chip != defaults.chip || arguments.tolerance != defaults.tolerance))
    throw BadArguments("--chip and --tolerance are for choose: leave them out");
}

std::string run(const Arguments& arguments) {
  if (arguments.command == "choose") {
    refuseUnused(arguments);
    return blink_codes_tool::cyclicFile(arguments.words, arguments.chip, arguments.tolerance);
  }
  if (arguments.command != "table" && arguments.command != "sketch" && arguments.command != "check")
    throw BadArguments("the command must be table, sketch, check or choose");
  refuseUnused(arguments);
  if (arguments.words.size() != 1)
    throw BadArguments("name one file");
  const identity::BlinkCodes codes = identity::readBlinkCodes(arguments.words[0]);
  if (arguments.command == "check")
    return blink_codes_tool::remarks(codes);
  const double period = periodOf(codes, arguments.period);
  return arguments.command == "table" ? blink_codes_tool::table(codes, period)
                                      : blink_codes_tool::sketch(codes, period);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  ArgumentParser parser(
      "blink_codes",
      "table FILE       prints when each LED of a file of blink codes is on and off\n"
      "sketch FILE      prints an Arduino sketch that blinks the LEDs\n"
      "check FILE       checks a file and prints the properties of its codes\n"
      "choose LABEL...  prints a file of cyclic codes, one for each label, with --chip and\n"
      "                 --tolerance");
  parser.positional("table|sketch|check|choose", &arguments.command);
  parser.positional("FILE|LABEL...", &arguments.words);
  parser.option("--period S", &arguments.period, 0.02, 5.0,
                "period of table and sketch [s]; default: the shortest one of the file if its LEDs "
                "blink together, else the nominal one");
  parser.option("--chip S", &arguments.chip, 0.001, 1.0, "duration of one character of a word [s]");
  parser.option("--tolerance T", &arguments.tolerance, 0.0, 0.05,
                "relative error of the LED drivers' clocks");
  return parser.run(argc, argv, [&] {
    std::fputs(run(arguments).c_str(), stdout);
    return 0;
  });
}
