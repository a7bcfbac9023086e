#include "arguments.h"

#include "tools/command_line.h"
#include "transport/transport.h"

namespace wiimote_tracker::list_wiimotes {

Arguments parseArguments(int argc, char** argv) {
  Arguments a;
  std::vector<std::string> replace;
  CLI::App app("Lists the Wii Remotes of this computer, and says for each problem what to do.",
               "list_wiimotes");
  app.add_flag("--identify", a.identify, "each free remote flashes its number in turn");
  app.add_option(
         "--write", a.write,
         "add new remotes to the cameras.yaml FILE as wiimote_1, ...; the names in it stay, "
         "and the old file is kept as FILE.bak")
      ->type_name("FILE");
  auto* const cameras =
      app.add_option("--cameras", a.cameras, "show the names from this cameras.yaml")
          ->type_name("FILE");
  app.add_option("--device", a.device, "list only this remote")->type_name("ADDRESS");
  app.add_option("--virtual", a.sockets, "list the virtual remotes at these sockets only")
      ->type_name("PATH");
  app.add_option("--replace", replace,
                 "CAMERA gets the remote with ADDRESS in the cameras.yaml; the calibration of its "
                 "lens is renamed")
      ->type_name("CAMERA ADDRESS")
      ->expected(2)
      ->needs(cameras);
  app.add_option("--camera-info", a.camera_info,
                 "where <camera>.yaml is (default: ~/.ros/camera_info)")
      ->type_name("FOLDER");
  app.footer(
      "Exit status: 0 when there are remotes and all are free or in use by a driver, 1 when not, "
      "2 for wrong arguments.");
  a.help = tools::parse(app, argc, argv);
  if (!replace.empty()) {
    a.replaced_camera = replace[0];
    a.new_address = replace[1];
  }
  try {
    if (!a.device.empty())
      a.device = transport::parseDeviceName(a.device).value;
  } catch (const transport::BadDeviceName& e) {
    throw tools::BadArguments(e.what());
  }
  return a;
}

}  // namespace wiimote_tracker::list_wiimotes
