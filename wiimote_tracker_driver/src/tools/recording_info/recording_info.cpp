// Says what is in recordings of Wii Remotes.
#include "summary.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <string>

namespace {

constexpr char kUsage[] =
    R"(Says what is in recordings of Wii Remotes.

  recording_info FILE...

Exit status: 0 when all are complete, 1 when one is cut off or damaged, 2 when one cannot be read.
)";

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
  const std::string first = argc > 1 ? argv[1] : "";
  if (first.empty() || first == "--help" || first == "-h") {
    std::fputs(kUsage, first.empty() ? stderr : stdout);
    return first.empty() ? 2 : 0;
  }
  int status = 0;
  for (int i = 1; i < argc; ++i)
    status = std::max(status, show(argv[i]));
  return status;
}
