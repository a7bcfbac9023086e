// Calibrates synchronised cameras from what they saw of one moving light, and from nothing else.

#include "report.h"
#include "source.h"

#include "wiimote_tracker_calibration/bundle/self_calibrate.h"
#include "wiimote_tracker_calibration/import/comparison.h"
#include "wiimote_tracker_calibration/import/number_table.h"

#include <chrono>
#include <cstdio>
#include <exception>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace bundle = wiimote_tracker::bundle;
namespace geometry = wiimote_tracker::geometry;
namespace import = wiimote_tracker::import;

const char* const kUsage =
    "usage: self_calibrate FOLDER_OR_BAG [options]\n"
    "  --camera-subset A,B,...  only these cameras\n"
    "  --estimate-intrinsics    lenses from the recording too (the default)\n"
    "  --fix-intrinsics FILE    lenses from a rig file, or from a folder with basenameN.rad\n"
    "  --one-lens               all views are of one camera, or of cameras with equal lenses\n"
    "  --points                 print the points too\n"
    "  --json FILE              write all figures, cameras and points\n";

struct Arguments {
  std::string source;
  std::vector<std::string> subset;
  std::optional<std::string> intrinsics;
  std::optional<std::string> json;
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

/// Nothing when they are not understood.
std::optional<Arguments> parse(int argc, char** argv) {
  Arguments arguments;
  bool estimate = false;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool has_value = i + 1 < argc;
    if (word == "--one-lens")
      arguments.one_lens = true;
    else if (word == "--points")
      arguments.points = true;
    else if (word == "--estimate-intrinsics")
      estimate = true;
    else if (word == "--camera-subset" && has_value)
      arguments.subset = split(argv[++i]);
    else if (word == "--fix-intrinsics" && has_value)
      arguments.intrinsics = argv[++i];
    else if (word == "--json" && has_value)
      arguments.json = argv[++i];
    else if (arguments.source.empty() && word[0] != '-')
      arguments.source = word;
    else
      return std::nullopt;
  }
  if (arguments.source.empty() || (arguments.intrinsics && (estimate || arguments.one_lens)))
    return std::nullopt;
  return arguments;
}

/// On the error output, about once a second, once it has taken a second.
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
  recording = import::subsetOf(recording, arguments.subset);
import::Recording used = recording;
if (arguments.intrinsics)
  import::takeIntrinsics(*arguments.intrinsics, &used);

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
options.fixed_lenses = arguments.intrinsics.has_value();
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
  const std::optional<Arguments> arguments = parse(argc, argv);
  if (!arguments) {
    std::fputs(kUsage, stderr);
    return 2;
  }
  try {
    const import::Report report = solve(*arguments);
    import::print(report, arguments->points, stdout);
    if (arguments->json)
      writeJson(report, *arguments->json);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "self_calibrate: %s\n", error.what());
    return 1;
  }
  return 0;
}
