#include "arguments.h"

#include "wiimote_tracker_driver/transport/transport.h"

namespace wiimote_tracker::list_wiimotes {

const char* const kUsage =
    R"(Lists the Wii Remotes of this computer, and says for each problem what to do.

  list_wiimotes [--identify] [--write FILE] [--cameras FILE] [--device ADDRESS]
                [--virtual SOCKET_PATH...]
  list_wiimotes --replace CAMERA ADDRESS --cameras FILE [--camera-info FOLDER]

  --identify       let each free remote flash its number in turn
  --write FILE     add the remotes that are not there to the cameras.yaml FILE, as wiimote_1, ...;
                   names that are there stay; the file before is kept as FILE.bak
  --cameras FILE   show the cameras' names from this cameras.yaml
  --device ADDRESS list this remote alone
  --virtual PATH.. list the virtual remotes at these sockets, and nothing of this computer
  --replace        CAMERA gets the remote with ADDRESS in the cameras.yaml FILE; the calibration of
                   its lens in FOLDER (default: ~/.ros/camera_info) is set aside

Exit status: 0 when there are remotes and all are free or in use by a driver, 1 when not, 2 for
arguments that make no sense.
)";

Arguments parseArguments(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const auto value = [&](int* at) -> std::string {
      if (*at + 1 >= argc || std::string(argv[*at + 1]).rfind("--", 0) == 0)
        throw BadArguments(argument + " lacks a value");
      return argv[++*at];
    };
    if (argument == "--help" || argument == "-h") {
      arguments.help = true;
    } else if (argument == "--identify") {
      arguments.identify = true;
    } else if (argument == "--write") {
      arguments.write = value(&i);
    } else if (argument == "--cameras") {
      arguments.cameras = value(&i);
    } else if (argument == "--device") {
      arguments.device = value(&i);
    } else if (argument == "--camera-info") {
      arguments.camera_info = value(&i);
    } else if (argument == "--replace") {
      arguments.replaced_camera = value(&i);
      arguments.new_address = value(&i);
    } else if (argument == "--virtual") {
      do {
        arguments.sockets.push_back(value(&i));
      } while (i + 1 < argc && argv[i + 1][0] != '-');
    } else {
      throw BadArguments("unknown argument " + argument);
    }
  }
  if (!arguments.replaced_camera.empty() && arguments.cameras.empty())
    throw BadArguments("--replace needs --cameras FILE");
  try {
    if (!arguments.device.empty())
      arguments.device = transport::parseDeviceName(arguments.device).value;
  } catch (const transport::BadDeviceName& e) {
    throw BadArguments(e.what());
  }
  return arguments;
}

}  // namespace wiimote_tracker::list_wiimotes
