#include "arguments.h"

#include <stdexcept>

namespace wiimote_tracker {
namespace {

std::string withSlashes(const std::string& name_space) {
  std::string result = name_space;
  if (result.empty() || result.front() != '/')
    result = "/" + result;
  if (result.back() != '/')
    result += "/";
  return result;
}

unsigned threadsOf(const std::string& text) {
  if (text.empty() || text.size() > 3 ||
      text.find_first_not_of("0123456789") != std::string::npos || std::stoul(text) == 0)
    throw std::invalid_argument("--threads is '" + text + "', but must be a number from 1 to 999");
  return static_cast<unsigned>(std::stoul(text));
}

}  // namespace

const char* const kUsage =
    "usage: track_bag IN.bag OUT.bag [--mode tracks|instant] [--params FILE] [--rig FILE]\n"
    "                 [--csv FILE] [--mat FILE] [--namespace NAME] [--results-only] [--threads N]\n"
    "Computes the points of a recording from its images and its rig, as the node would have done\n"
    "with nothing delayed on the way. OUT.bag gets the recording without what was computed "
    "before,\n"
    "and the new points, transforms, zone events and points at triggers.\n"
    "  --mode          instead of the parameters' mode\n"
    "  --params        YAML with the node's parameters (config/triangulation.yaml); default: "
    "those\n"
    "                  defaults\n"
    "  --rig           rig.yaml to use instead of the rigs in the bag\n"
    "  --csv, --mat    also write the points as comma-separated values, as a MATLAB file\n"
    "  --namespace     of the tracker's topics; default: that of the rig in the bag\n"
    "  --results-only  leave the recording itself out of OUT.bag\n"
    "  --threads       default: as many as are of use. The result does not depend on it.\n";

Arguments readArguments(int argc, const char* const* argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    const auto value = [&] {
      if (i + 1 == argc)
        throw std::invalid_argument(option + " needs a value");
      return std::string(argv[++i]);
    };
    if (option == "--help" || option == "-h")
      arguments.wants_help = true;
    else if (option == "--mode")
      arguments.mode = value();
    else if (option == "--params")
      arguments.parameters = value();
    else if (option == "--rig")
      arguments.rig = value();
    else if (option == "--csv")
      arguments.csv = value();
    else if (option == "--mat")
      arguments.matlab = value();
    else if (option == "--namespace")
      arguments.name_space = withSlashes(value());
    else if (option == "--results-only")
      arguments.results_only = true;
    else if (option == "--threads")
      arguments.threads = threadsOf(value());
    else if (option.compare(0, 1, "-") == 0)
      throw std::invalid_argument("'" + option + "' is not understood");
    else if (arguments.input.empty())
      arguments.input = option;
    else if (arguments.output.empty())
      arguments.output = option;
    else
      throw std::invalid_argument("'" + option + "' is one file too many");
  }
  if (!arguments.wants_help && arguments.output.empty())
    throw std::invalid_argument("name the bag to read and the bag to write");
  return arguments;
}

}  // namespace wiimote_tracker
