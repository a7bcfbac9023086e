// Summarises recordings of Wii Remotes.
#include "summary.h"

#include <wiimote_tracker_msgs/argument_parser.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

namespace {

/// @returns the exit status.
int show(const std::string& path) {
  namespace info = wiimote_tracker::recording_info;
  try {
    std::ifstream file = wiimote_tracker::recording::openRecording(path);
    wiimote_tracker::recording::Reader reader(file);
    const info::Summary summary = info::summarize(reader);
    std::printf("%s\n%s", path.c_str(), info::describe(summary).c_str());
    return summary.damage.empty() ? 0 : 1;
  } catch (const wiimote_tracker::recording::BadRecording& e) {
    std::fprintf(stderr, "%s: %s\n", path.c_str(), e.what());
    return 2;
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> files;
  wiimote_tracker::ArgumentParser parser(
      "recording_info",
      "Summarises recordings of Wii Remotes.\n"
      "Exit status: 0 when all are complete, 1 when one is cut off or damaged, 2 when one cannot "
      "be read.");
  parser.positional("FILE...", &files);
  return parser.run(argc, argv, [&] {
    int status = 0;
    for (const std::string& file : files)
      status = std::max(status, show(file));
    return status;
  });
}
