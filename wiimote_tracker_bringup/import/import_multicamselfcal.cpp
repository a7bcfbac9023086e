// Converts a folder in the layout of MultiCamSelfCal or flydra to a bag of this tracker.

#include "bag.h"
#include "solution.h"
#include "wiimote_tracker_calibration/import/recording.h"

#include <wiimote_tracker_msgs/argument_parser.h>

#include <cstdio>
#include <string>

namespace {

int convert(const std::string& folder, const std::string& bag) {
  namespace import = wiimote_tracker::import;
  const import::Recording recording = import::readRecording(folder);
  const import::Solution solution = import::solve(recording);
  import::writeBag(solution, bag);
  std::printf("%zu cameras, %zu frames: %s\n%s\n%s\n", recording.cameras.size(),
              recording.frames.size(), bag.c_str(), solution.rig.method.c_str(),
              solution.rig.verdict.c_str());
  if (!recording.cameras.front().center)
    std::printf("no camera centres shipped: the scale of this world is arbitrary\n");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::string folder, bag;
  wiimote_tracker::ArgumentParser parser(
      "import_multicamselfcal",
      "Converts a folder in the layout of MultiCamSelfCal or flydra to a bag of this tracker.");
  parser.positional("FOLDER", &folder);
  parser.positional("OUT.bag", &bag);
  return parser.run(argc, argv, [&] { return convert(folder, bag); });
}
