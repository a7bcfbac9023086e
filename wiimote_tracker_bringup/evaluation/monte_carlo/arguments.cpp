#include "arguments.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <random>
#include <stdexcept>

namespace wiimote_tracker::monte_carlo {
namespace {

long number(const std::string& option, const std::string& text, long low, long high) {
  char* end = nullptr;
  const long value = std::strtol(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || value < low || value > high)
    throw std::invalid_argument(option + " is '" + text + "', but must be a whole number between " +
                                std::to_string(low) + " and " + std::to_string(high));
  return value;
}

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; i += 2) {
    const std::string option = argv[i];
    if (i + 1 == argc)
      throw std::invalid_argument(option + " needs a value; --help lists the options");
    const std::string value = argv[i + 1];
    if (option == "--rig")
      arguments.rig = value;
    else if (option == "--output")
      arguments.output = value;
    else if (option == "--seed")
      arguments.seed = static_cast<std::uint32_t>(number(option, value, 0, 2147483647));
    else if (option == "--sessions")
      arguments.sessions = static_cast<int>(number(option, value, 1, 100000));
    else if (option == "--first")
      arguments.first = static_cast<int>(number(option, value, 0, 100000));
    else
      throw std::invalid_argument("there is no option " + option + "; --help lists them");
  }
  if (arguments.rig.empty() || arguments.output.empty())
    throw std::invalid_argument("--rig and --output are needed");
  return arguments;
}

}  // namespace

std::uint32_t sessionSeed(const Arguments& arguments, int session) {
  std::seed_seq sequence{arguments.seed, static_cast<std::uint32_t>(session)};
  std::uint32_t seed = 0;
  sequence.generate(&seed, &seed + 1);
  return seed;
}

int runProgram(int argc,
               char** argv,
               const std::string& purpose,
               const std::function<void(const Arguments&)>& measure) {
  try {
    for (int i = 1; i < argc; ++i) {
      if (std::string(argv[i]) == "--help" || std::string(argv[i]) == "-h") {
        std::printf(
            "usage: %s --rig FILE --output FILE [--seed N] [--sessions N] [--first N]\n%s\n"
            "Everything is simulated; the same seed gives the same bytes.\n",
            argv[0], purpose.c_str());
        return 0;
      }
    }
    measure(parse(argc, argv));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 1;
  }
}

}  // namespace wiimote_tracker::monte_carlo
