// Calibrates synchronised cameras from what they saw of one moving light alone.

#include "report.h"
#include "source.h"

#include "wiimote_tracker_calibration/bundle/self_calibrate.h"
#include "wiimote_tracker_calibration/import/comparison.h"
#include "wiimote_tracker_calibration/import/number_table.h"

#include <CLI/CLI.hpp>

#include <chrono>
#include <cstdio>
#include <exception>
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

void addTo(CLI::App* app, Arguments* arguments) {
  app->add_option("FOLDER_OR_BAG", arguments->source, "Recording")->required();
  app->add_option("--camera-subset", arguments->subset, "Use only these cameras: A,B,...");
  auto* const estimate = app->add_flag("--estimate-intrinsics", "Estimate the lenses (default)");
  auto* const fix = app->add_option("--fix-intrinsics", arguments->intrinsics,
                                    "Lenses from a rig file, or a folder with basenameN.rad");
  auto* const one_lens =
      app->add_flag("--one-lens", arguments->one_lens, "All cameras have the same lens");
  fix->excludes(estimate)->excludes(one_lens);
  app->add_flag("--points", arguments->points, "Print the points too");
  app->add_option("--json", arguments->json, "Write all figures, cameras and points to a file");
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
  CLI::App app("Calibrates synchronised cameras from what they saw of one moving light alone.");
  Arguments arguments;
  addTo(&app, &arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    const import::Report report = solve(arguments);
    import::print(report, arguments.points, stdout);
    if (!arguments.json.empty())
      writeJson(report, arguments.json);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "self_calibrate: %s\n", error.what());
    return 1;
  }
  return 0;
}
