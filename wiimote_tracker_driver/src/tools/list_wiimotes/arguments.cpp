#include "arguments.h"

#include "transport/transport.h"

namespace wiimote_tracker::list_wiimotes {

ArgumentParser parserOf(Arguments* arguments) {
  ArgumentParser parser(
      "list_wiimotes",
      "Lists the Wii Remotes of this computer, and says for each problem what to do.\n"
      "Exit status: 0 when there are remotes and all are free or in use by a driver, 1 when not,\n"
      "2 for wrong arguments.");
  parser.flag("--identify", &arguments->identify, "each free remote flashes its number in turn");
  parser.option("--write FILE", &arguments->write,
                "add new remotes to the cameras.yaml FILE as wiimote_1, ...; the names in it stay, "
                "and the old file is kept as FILE.bak");
  parser.option("--cameras FILE", &arguments->cameras, "show the names from this cameras.yaml");
  parser.option("--device ADDRESS", &arguments->device, "list only this remote");
  parser.option("--virtual PATH...", &arguments->sockets,
                "list the virtual remotes at these sockets only");
  parser.option("--replace CAMERA ADDRESS", &arguments->replace,
                "CAMERA gets the remote with ADDRESS in the cameras.yaml; the calibration of its "
                "lens is renamed");
  parser.option("--camera-info FOLDER", &arguments->camera_info,
                "where <camera>.yaml is (default: ~/.ros/camera_info)");
  return parser;
}

void check(Arguments* arguments) {
  const bool replaces = !arguments->replace.empty();
  if (replaces && (arguments->replace.size() != 2 || arguments->cameras.empty()))
    throw BadArguments("--replace needs CAMERA ADDRESS, and --cameras FILE");
  try {
    if (!arguments->device.empty())
      arguments->device = transport::parseDeviceName(arguments->device).value;
  } catch (const transport::BadDeviceName& e) {
    throw BadArguments(e.what());
  }
}

}  // namespace wiimote_tracker::list_wiimotes
