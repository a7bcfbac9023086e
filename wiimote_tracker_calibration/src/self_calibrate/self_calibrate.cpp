// Calibrates synchronised cameras from what they saw of one moving light alone.

#include "bag.h"
#include "report.h"

#include "samples/grade.h"
#include "wiimote_tracker_calibration/bundle/self_calibrate.h"
#include "wiimote_tracker_calibration/bundle/statistics.h"
#include "wiimote_tracker_calibration/import/comparison.h"
#include "wiimote_tracker_calibration/import/recording.h"

#include <wiimote_tracker_msgs/argument_parser.h>
#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/rig_file.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace {

using namespace wiimote_tracker;
using namespace wiimote_tracker::self_calibrate;
using import::ImportError;
using import::Pixels;
using import::RecordedCamera;
using import::Recording;

struct Arguments {
  std::string source;
  std::string subset;      // names with commas; empty: all cameras
  std::string intrinsics;  // empty: to be estimated
  std::string json;        // empty: none
  std::string rig;         // empty: none
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
    throw BadArguments("--fix-intrinsics excludes --estimate-intrinsics and --one-lens");
  for (const std::string& output : {arguments.json, arguments.rig}) {
    for (const std::string& input : {arguments.source, arguments.intrinsics}) {
      std::error_code missing;
      if (std::filesystem::equivalent(output, input, missing))
        throw BadArguments("two arguments are " + output + ": write to another file");
    }
  }
}

/// The named cameras, in the order of the recording. @throws ImportError for an unknown name.
Recording subsetOf(const Recording& recording, const std::vector<std::string>& names) {
  std::vector<std::size_t> kept;
  std::vector<std::string> known;
  for (std::size_t i = 0; i < recording.cameras.size(); ++i) {
    known.push_back(recording.cameras[i].name);
    if (std::find(names.begin(), names.end(), recording.cameras[i].name) != names.end())
      kept.push_back(i);
  }
  if (kept.size() != names.size())
    throw ImportError("the camera subset must name cameras of the recording once each; it has: " +
                      joined(known));
  Recording subset;
  for (const std::size_t i : kept)
    subset.cameras.push_back(recording.cameras[i]);
  for (const Pixels& all : recording.frames) {
    Pixels pixels;
    for (const std::size_t i : kept)
      pixels.push_back(all[i]);
    subset.frames.push_back(pixels);
  }
  subset.points = recording.points;
  return subset;
}

/// Takes the intrinsics of all cameras, by name, from a rig file or from the folder of a recording.
/// @throws ImportError: a camera is missing there, or has another image size; Error as
/// readRigFile().
void takeIntrinsics(const std::string& path, Recording* recording) {
  std::map<std::string, geometry::Intrinsics> by_name;
  if (import::fileExists(path + "/Res.dat")) {
    for (const RecordedCamera& camera : import::readRecording(path).cameras)
      by_name[camera.name] = camera.intrinsics;
  } else {
    for (const geometry::RigCamera& camera : geometry::readRigFile(path).cameras)
      by_name[camera.camera.name] = camera.camera.intrinsics;
  }
  for (RecordedCamera& camera : recording->cameras) {
    const auto found = by_name.find(camera.name);
    if (found == by_name.end())
      throw ImportError(path + " has no intrinsics of " + camera.name +
                        ": add them, or leave the camera out with --camera-subset");
    if (found->second.width != camera.intrinsics.width ||
        found->second.height != camera.intrinsics.height)
      throw ImportError(path + " has intrinsics of " + camera.name +
                        " for another image size than the recording");
    camera.intrinsics = found->second;
    camera.has_intrinsics = true;
  }
}

Report solve(const Arguments& arguments) {
  Recording recording = import::fileExists(arguments.source + "/Res.dat")
                            ? import::readRecording(arguments.source, false)
                            : readBag(arguments.source);
  if (!arguments.subset.empty())
    recording = subsetOf(recording, split(arguments.subset));
  Recording used = recording;
  if (!arguments.intrinsics.empty())
    takeIntrinsics(arguments.intrinsics, &used);
  bundle::SelfCalibrationOptions options;
  options.bundle.fixed_lenses = !arguments.intrinsics.empty();
  options.bundle.one_lens = arguments.one_lens;
  Report report;
  report.source = arguments.source;
  report.frames = used.frames.size();
  report.lenses_given = options.bundle.fixed_lenses;
  // At most once a second.
  using Clock = std::chrono::steady_clock;
  const auto show = [shown = Clock::now()](const std::string& step, double fraction) mutable {
    if (Clock::now() - shown <= std::chrono::seconds(1))
      return;
    shown = Clock::now();
    std::fprintf(stderr, "%3.0f %% %s\n", 100.0 * fraction, step.c_str());
  };
  report.solution = bundle::selfCalibrate(import::observedBy(used), options, show);
  report.comparison = import::compare(recording, report.solution, options.bundle);
  return report;
}

void writeJson(const Report& report, const std::string& path) {
  std::ofstream file(path);
  file << jsonText(report) << std::flush;
  if (!file)
    throw ImportError(path + " cannot be written: choose another place or make room there");
}

/// The cameras as a rig, whose scale is arbitrary.
geometry::Rig rigOf(const Report& report) {
  const bundle::Reconstruction& reconstruction = report.solution.reconstruction;
  // The fit follows the noise in part: corrected, the residuals tell all of it.
  const double rms = bundle::statistics(reconstruction).rms;
  const double correction = rms > 0.0 ? std::sqrt(2.0) * report.solution.pixel_stddev / rms : 1.0;
  geometry::Rig rig = bundle::rigOf(reconstruction, correction);
  rig.method = "self_calibrate";
  rig.verdict = samples::nameOf(samples::Grade::kUsable) +
                ": the scale is arbitrary, so that distances and speeds are not in metres";
  return rig;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  ArgumentParser parser(
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
  parser.option("--rig FILE", &arguments.rig, "write the rig; its scale is arbitrary");
  return parser.run(argc, argv, [&] {
    check(arguments);
    const Report report = solve(arguments);
    print(report, arguments.points, stdout);
    if (!arguments.json.empty())
      writeJson(report, arguments.json);
    if (!arguments.rig.empty())
      geometry::writeRigFile(rigOf(report), arguments.rig);
    return 0;
  });
}
