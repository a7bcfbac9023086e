// Calibrates synchronised cameras from what they saw of one moving light alone.

#include "report.h"
#include "source.h"

#include "wiimote_tracker_calibration/bundle/self_calibrate.h"
#include "wiimote_tracker_calibration/import/comparison.h"
#include "wiimote_tracker_calibration/import/number_table.h"

#include <wiimote_tracker_msgs/argument_parser.h>

#include <chrono>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace bundle = wiimote_tracker::bundle;
namespace geometry = wiimote_tracker::geometry;
namespace import = wiimote_tracker::import;

struct Arguments {
  std::string source;
  std::string subset;      // names with commas; empty: all cameras
  std::string intrinsics;  // empty: to be estimated
  std::string json;        // empty: none
  bool estimate = false;   // the intrinsics, as without --fix-intrinsics
  bool one_lens = false;
  bool points = false;
};

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');)
    parts.push_back(part);
  return parts;
}

/// @throws BadArguments.
void check(const Arguments& arguments) {
  if (!arguments.intrinsics.empty() && (arguments.estimate || arguments.one_lens))
    throw wiimote_tracker::BadArguments(
        "--fix-intrinsics excludes --estimate-intrinsics and --one-lens");
}

/// Prints the progress to the standard error output, at most once a second.
class ProgressLine {
 public:
  bool operator()(const std::string& step, double fraction) {
    const auto now = std::chrono::steady_clock::now();
    if (now - shown_ > std::chrono::seconds(1)) {
      shown_ = now;
      std::fprintf(stderr, "%3.0f %% %s\n", 100.0 * fraction, step.c_str());
    }
    return true;
  }

 private:
  std::chrono::steady_clock::time_point shown_ = std::chrono::steady_clock::now();
};

import::Report solve(const Arguments& arguments){
    import::Recording recording = import::fileExists(arguments.source + "/Res.dat")
                                      ? import::readRecording(arguments.source, false)
                                      : import::readBag(arguments.source);
if (!arguments.subset.empty())
  recording = import::subsetOf(recording, split(arguments.subset));
import::Recording used = recording;
if (!arguments.intrinsics.empty())
  import::takeIntrinsics(arguments.intrinsics, &used);

std::vector<geometry::Camera> cameras;
for (const import::RecordedCamera& recorded : used.cameras) {
  geometry::Camera camera;
  camera.name = recorded.name;
  camera.intrinsics = recorded.intrinsics;
  cameras.push_back(camera);
}
std::vector<bundle::Observation> observations;
for (std::size_t frame = 0; frame < used.frames.size(); ++frame) {
  for (std::size_t camera = 0; camera < cameras.size(); ++camera) {
    if (const auto& pixel = used.frames[frame][camera])
      observations.push_back({camera, frame, *pixel});
  }
}
bundle::SelfCalibrationOptions options;
options.fixed_lenses = !arguments.intrinsics.empty();
options.bundle.one_lens = arguments.one_lens;
import::Report report;
report.source = arguments.source;
report.frames = used.frames.size();
report.lenses_given = options.fixed_lenses;
report.solution =
    bundle::selfCalibrate(cameras, observations, used.frames.size(), options, ProgressLine());
report.comparison = import::compare(recording, report.solution, options.bundle);
return report;
}  // namespace

void writeJson(const import::Report& report, const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (file == nullptr)
    throw import::ImportError(path + " cannot be written");
  import::printJson(report, file);
  const bool failed = std::ferror(file) != 0;
  if (std::fclose(file) != 0 || failed)
    throw import::ImportError(path + " cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  wiimote_tracker::ArgumentParser parser(
      "self_calibrate",
      "Calibrates synchronised cameras from what they saw of one moving light alone.");
  parser.positional("FOLDER_OR_BAG", &arguments.source);
  parser.option("--camera-subset A,B,...", &arguments.subset, "use only these cameras");
  parser.flag("--estimate-intrinsics", &arguments.estimate, "estimate the lenses (default)");
  parser.option("--fix-intrinsics FILE", &arguments.intrinsics,
                "lenses from a rig file, or a folder with basenameN.rad");
  parser.flag("--one-lens", &arguments.one_lens, "all cameras have the same lens");
  parser.flag("--points", &arguments.points, "print the points too");
  parser.option("--json FILE", &arguments.json, "write all figures, cameras and points");
  return parser.run(argc, argv, [&] {
    check(arguments);
    const import::Report report = solve(arguments);
    import::print(report, arguments.points, stdout);
    if (!arguments.json.empty())
      writeJson(report, arguments.json);
    return 0;
  });
}
