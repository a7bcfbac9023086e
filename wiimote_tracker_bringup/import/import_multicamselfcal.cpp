// Converts a folder in the layout of MultiCamSelfCal or flydra to a bag of this tracker.

#include "bag.h"
#include "solution.h"
#include "wiimote_tracker_calibration/import/number_table.h"
#include "wiimote_tracker_calibration/import/recording.h"

#include <cstdio>
#include <exception>

int main(int argc, char** argv) {
  namespace import = wiimote_tracker::import;
  if (argc != 3) {
    std::fprintf(stderr, "usage: import_multicamselfcal FOLDER OUT.bag\n");
    return 2;
  }
  try {
    const import::Recording recording = import::readRecording(argv[1]);
    const import::Solution solution = import::solve(recording);
    import::writeBag(solution, argv[2]);
    std::printf("%zu cameras, %zu frames: %s\n%s\n", recording.cameras.size(),
                recording.frames.size(), argv[2], solution.rig.method.c_str());
    std::printf("%s\n", solution.rig.verdict.c_str());
    if (!recording.cameras.front().center)
      std::printf("no camera centres shipped: the scale of this world is arbitrary\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "import_multicamselfcal: %s\n", error.what());
    return 1;
  }
  return 0;
}
