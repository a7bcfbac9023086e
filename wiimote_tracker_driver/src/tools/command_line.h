#ifndef WIIMOTE_TRACKER_DRIVER_TOOLS_COMMAND_LINE_H
#define WIIMOTE_TRACKER_DRIVER_TOOLS_COMMAND_LINE_H

#include <wiimote_tracker_msgs/error.h>

#include <CLI/CLI.hpp>
#include <string>

namespace wiimote_tracker::tools {

/// Wrong arguments; a program then exits with status 2.
struct BadArguments : Error {
  using Error::Error;
};

/// Parses the arguments into the variables of `app`. @returns the help text if the user asked for
/// it, else an empty string. @throws BadArguments.
inline std::string parse(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return app.help();
  } catch (const CLI::ParseError& e) {
    throw BadArguments(e.what() + std::string("; see --help"));
  }
  return "";
}

}  // namespace wiimote_tracker::tools

#endif  // WIIMOTE_TRACKER_DRIVER_TOOLS_COMMAND_LINE_H
