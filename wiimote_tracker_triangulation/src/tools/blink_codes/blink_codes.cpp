// Tables and Arduino sketches for LEDs that are identified by blink codes.

#include "listing.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/identity/codes_file.h"

#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace wiimote_tracker;

const char* const kUsage =
    "usage: blink_codes table|sketch|check FILE [--period S]\n"
    "       blink_codes choose LABEL... [--chip S] [--tolerance T]\n"
    "  table   prints when each LED of a file of blink codes is on and off\n"
    "  sketch  prints an Arduino sketch that blinks the LEDs\n"
    "  check   checks a file and prints the properties of its codes\n"
    "  choose  prints a file of cyclic codes, one for each label\n"
    "  --period S     period of table and sketch [s]; default: the shortest one of the file\n"
    "                 if its LEDs blink together, else the nominal one\n"
    "  --chip S       duration of one character of a word [s]; default 0.023\n"
    "  --tolerance T  relative error of the LED drivers' clocks; default 0.01\n";

double positive(const std::string& option, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(value > 0.0 && value < 100.0))
    throw std::invalid_argument(option + " is '" + text + "', but must be a number above 0");
  return value;
}

struct Arguments {
  std::string command;
  std::vector<std::string> words;
  double period = 0.0;  // 0: the file's
  double chip = 0.023;
  double tolerance = 0.01;
};

Arguments argumentsOf(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.rfind("--", 0) != 0) {
      if (arguments.command.empty())
        arguments.command = word;
      else
        arguments.words.push_back(word);
      continue;
    }
    if (word != "--period" && word != "--chip" && word != "--tolerance")
      throw std::invalid_argument("unknown option " + word);
    if (++i == argc)
      throw std::invalid_argument(word + " needs a value");
    (word == "--period" ? arguments.period
     : word == "--chip" ? arguments.chip
                        : arguments.tolerance) = positive(word, argv[i]);
  }
  return arguments;
}

/// The period for driving the LEDs [s].
double periodOf(const identity::BlinkCodes& codes, double wanted) {
  // A file of cyclic codes has one nominal period and a tolerance.
  if (wanted == 0.0)
    return codes.synchronous ? codes.shortest_period
                             : 0.5 * (codes.shortest_period + codes.longest_period);
  if (wanted < codes.shortest_period * (1.0 - 1e-9) || wanted > codes.longest_period * (1.0 + 1e-9))
    throw std::invalid_argument("--period is outside the range of the file");
  return wanted;
}

std::string run(const Arguments& arguments) {
  if (arguments.command == "choose") {
    if (arguments.words.empty())
      throw std::invalid_argument("choose needs labels");
    return blink_codes_tool::cyclicFile(arguments.words, arguments.chip, arguments.tolerance);
  }
  if (arguments.command != "table" && arguments.command != "sketch" && arguments.command != "check")
    throw std::invalid_argument("the command must be table, sketch, check or choose");
  if (arguments.words.size() != 1)
    throw std::invalid_argument("name one file");
  const identity::BlinkCodes codes = identity::readBlinkCodes(arguments.words[0]);
  if (arguments.command == "check")
    return blink_codes_tool::remarks(codes);
  const double period = periodOf(codes, arguments.period);
  return arguments.command == "table" ? blink_codes_tool::table(codes, period)
                                      : blink_codes_tool::sketch(codes, period);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && (std::string(argv[1]) == "-h" || std::string(argv[1]) == "--help")) {
    std::fputs(kUsage, stdout);
    return 0;
  }
  try {
    std::fputs(run(argumentsOf(argc, argv)).c_str(), stdout);
    return 0;
  } catch (const std::invalid_argument& e) {
    std::fprintf(stderr, "blink_codes: %s.\n%s", e.what(), kUsage);
    return 2;
  } catch (const geometry::Error& e) {
    std::fprintf(stderr, "blink_codes: %s.\n", e.what());
    return 1;
  }
}
