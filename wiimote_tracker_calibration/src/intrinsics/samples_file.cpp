#include "wiimote_tracker_calibration/intrinsics/samples_file.h"

#include "wiimote_tracker_calibration/intrinsics/error.h"

#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <limits>

namespace wiimote_tracker::intrinsics {

namespace {

constexpr const char* kKind = "wiimote_tracker board samples";
constexpr int kVersion = 1;

std::string yamlOf(const Samples& samples) {
  YAML::Emitter out;
  out.SetDoublePrecision(std::numeric_limits<double>::max_digits10);
  out << YAML::BeginMap;
  out << YAML::Key << "kind" << YAML::Value << kKind;
  out << YAML::Key << "version" << YAML::Value << kVersion;
  out << YAML::Key << "column_spacing" << YAML::Value << samples.board.column_spacing
      << YAML::Comment("m");
  out << YAML::Key << "row_spacing" << YAML::Value << samples.board.row_spacing
      << YAML::Comment("m");
  out << YAML::Key << "width" << YAML::Value << samples.width << YAML::Comment("px");
  out << YAML::Key << "height" << YAML::Value << samples.height << YAML::Comment("px");
  out << YAML::Key << "views" << YAML::Comment("number of the LED: [x, y] in px") << YAML::Value
      << YAML::BeginSeq;
  for (const BoardView& view : samples.views) {
    out << YAML::BeginMap;
    for (int led = 0; led < kBoardLeds; ++led) {
      const auto& pixel = view.pixels[static_cast<std::size_t>(led)];
      if (pixel)
        out << YAML::Key << led << YAML::Value << YAML::Flow << YAML::BeginSeq << pixel->x()
            << pixel->y() << YAML::EndSeq;
    }
    out << YAML::EndMap;
  }
  out << YAML::EndSeq << YAML::EndMap;
  return out.c_str();
}

/// A file cut off at any place lacks it.
constexpr const char* kEnd = "\n...\n";

void require(bool condition, const std::string& what) {
  if (!condition)
    throw SamplesFileError(what);
}

BoardView viewOf(const YAML::Node& node) {
  BoardView view;
  require(node.IsMap(), "a view is not a list of LEDs");
  for (const auto& entry : node) {
    const int led = entry.first.as<int>();
    require(led >= 0 && led < kBoardLeds, "an LED's number is not 0 to 15");
    require(entry.second.size() == 2, "an LED has not two coordinates");
    const Eigen::Vector2d pixel(entry.second[0].as<double>(), entry.second[1].as<double>());
    require(pixel.allFinite(), "a coordinate is not finite");
    auto& place = view.pixels[static_cast<std::size_t>(led)];
    require(!place, "an LED occurs twice in a view");
    place = pixel;
  }
  return view;
}

Samples samplesOf(const YAML::Node& root) {
  require(root.IsMap() && root["kind"] && root["kind"].as<std::string>() == kKind,
          "it holds no samples of the board");
  require(root["version"].as<int>() == kVersion, "its version is unknown");
  Samples samples;
  samples.board.column_spacing = root["column_spacing"].as<double>();
  samples.board.row_spacing = root["row_spacing"].as<double>();
  samples.board.check();
  samples.width = root["width"].as<int>();
  samples.height = root["height"].as<int>();
  require(samples.width > 0 && samples.height > 0, "the image size is not above 0");
  require(root["views"].IsSequence(), "views are missing");
  for (const YAML::Node& view : root["views"])
    samples.views.push_back(viewOf(view));
  return samples;
}

}  // namespace

void writeSamplesFile(const Samples& samples, const std::string& path) {
  const std::string fresh = path + ".new" + std::to_string(::getpid());
  bool written = false;
  {
    std::ofstream file(fresh, std::ios::binary);
    file << yamlOf(samples) << kEnd;
    file.close();
    written = !file.fail();
  }
  if (!written || std::rename(fresh.c_str(), path.c_str()) != 0) {
    std::remove(fresh.c_str());
    throw SamplesFileError("cannot write " + path +
                           ": choose a folder that exists and may be "
                           "written to, on a disk with room");
  }
}

Samples readSamplesFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const std::string advice = "; choose a file that was written by this package";
  if (!file)
    throw SamplesFileError("cannot read " + path + advice);
  const std::string end = kEnd;
  try {
    require(
        text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0,
        "its end is missing");
    return samplesOf(YAML::Load(text));
  } catch (const std::exception& error) {
    throw SamplesFileError("cannot use " + path + ": " + error.what() + advice);
  }
}

}  // namespace wiimote_tracker::intrinsics
