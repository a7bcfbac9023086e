#include "samples_yaml.h"

#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/yaml_map.h>

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>

namespace wiimote_tracker::samples {

namespace {

using geometry::YamlMap;

constexpr const char* kFormat = "wiimote_tracker_samples";
constexpr int kVersion = 1;

template <typename Numbers>
void emitNumbers(const Numbers& numbers, YAML::Emitter& out) {
  out << YAML::Flow << YAML::BeginSeq;
  for (decltype(numbers.size()) i = 0; i < numbers.size(); ++i)
    out << exactNumber(numbers[i]);
  out << YAML::EndSeq;
}

void emitKey(const std::string& key, double value, YAML::Emitter& out) {
  out << YAML::Key << key << YAML::Value << exactNumber(value);
}

void emitLengths(const std::vector<square::TapedLength>& lengths, YAML::Emitter& out) {
  out << YAML::Key << "lengths" << YAML::Value << YAML::BeginSeq;
  for (const square::TapedLength& taped : lengths) {
    out << YAML::Flow << YAML::BeginMap;
    out << YAML::Key << "from" << YAML::Value << taped.from + 1;
    out << YAML::Key << "to" << YAML::Value << taped.to + 1;
    emitKey("length", taped.length, out);
    emitKey("stddev", taped.stddev, out);
    out << YAML::EndMap;
  }
  out << YAML::EndSeq;
}

void emitPlaces(const std::vector<square::KnownPlace>& places, YAML::Emitter& out) {
  out << YAML::Key << "places" << YAML::Value << YAML::BeginSeq;
  for (const square::KnownPlace& place : places) {
    out << YAML::Flow << YAML::BeginMap << YAML::Key << "position" << YAML::Value;
    emitNumbers(place.position, out);
    emitKey("stddev", place.stddev, out);
    out << YAML::EndMap;
  }
  out << YAML::EndSeq;
}

void emitSquare(const std::optional<square::SquareLayout>& square, YAML::Emitter& out) {
  out << YAML::Key << "square" << YAML::Value;
  if (!square) {
    out << YAML::Null;
    return;
  }
  out << YAML::BeginMap;
  emitKey("side_x", square->side_x, out);
  emitKey("side_y", square->side_y, out);
  emitKey("led_height", square->led_height, out);
  out << YAML::Key << "origin" << YAML::Value;
  emitNumbers(square->origin, out);
  emitKey("yaw", square->yaw, out);
  // Older programs refuse these keys.
  if (!square->lengths.empty())
    emitLengths(square->lengths, out);
  if (!square->places.empty())
    emitPlaces(square->places, out);
  out << YAML::EndMap;
}

void emitWand(const std::optional<wave::Wand>& wand, YAML::Emitter& out) {
  out << YAML::Key << "wand" << YAML::Value;
  if (!wand) {
    out << YAML::Null;
    return;
  }
  out << YAML::BeginMap;
  emitKey("length", wand->length, out);
  emitKey("stddev", wand->stddev, out);
  if (wand->led_height)  // older programs refuse this key
    emitKey("led_height", *wand->led_height, out);
  out << YAML::EndMap;
}

void emitLens(const geometry::Intrinsics& lens, YAML::Emitter& out) {
  out << YAML::Key << "lens" << YAML::Value << YAML::BeginMap;
  out << YAML::Key << "width" << YAML::Value << lens.width;
  out << YAML::Key << "height" << YAML::Value << lens.height;
  emitKey("fx", lens.fx, out);
  emitKey("fy", lens.fy, out);
  emitKey("cx", lens.cx, out);
  emitKey("cy", lens.cy, out);
  out << YAML::Key << "distortion_model" << YAML::Value << geometry::nameOf(lens.distortion_model);
  out << YAML::Key << "distortion" << YAML::Value;
  emitNumbers(std::vector<double>(
                  lens.distortion.begin(),
                  lens.distortion.begin() + static_cast<std::ptrdiff_t>(
                                                geometry::coefficientCount(lens.distortion_model))),
              out);
  out << YAML::EndMap;
}

template <typename Pixels>
void emitPixels(const char* key, const Pixels& pixels, YAML::Emitter& out) {
  out << YAML::Key << key << YAML::Value << YAML::BeginSeq;
  for (const auto& pixel : pixels) {
    if (pixel)
      emitNumbers(*pixel, out);
    else
      out << YAML::Null;
  }
  out << YAML::EndSeq;
}

void emitCamera(const wave::CameraRecording& camera, YAML::Emitter& out) {
  const square::CameraSightings& sightings = camera.sightings;
  out << YAML::BeginMap;
  out << YAML::Key << "name" << YAML::Value << YAML::DoubleQuoted << sightings.name;
  out << YAML::Key << "identity" << YAML::Value << YAML::DoubleQuoted << sightings.identity;
  emitLens(sightings.intrinsics, out);
  out << YAML::Key << "gravity" << YAML::Value;
  if (sightings.gravity)
    emitNumbers(*sightings.gravity, out);
  else
    out << YAML::Null;
  out << YAML::Key << "clock_epoch" << YAML::Value << camera.clock_epoch;
  emitPixels("corners", sightings.corners, out);
  if (!sightings.places.empty())
    emitPixels("places", sightings.places, out);
  out << YAML::Key << "masks" << YAML::Value << YAML::BeginSeq;
  for (const geometry::ImageMask& mask : camera.masks) {
    out << YAML::Flow << YAML::BeginMap << YAML::Key << "center" << YAML::Value;
    emitNumbers(mask.center, out);
    emitKey("radius", mask.radius, out);
    out << YAML::EndMap;
  }
  out << YAML::EndSeq;
  out << YAML::Key << "frames" << YAML::Value << camera.frames.size();
  out << YAML::EndMap;
}

Eigen::VectorXd readVector(YamlMap& map, const std::string& key, std::size_t size) {
  const std::vector<double> numbers = map.numbers(key, size);
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), static_cast<Eigen::Index>(size));
}

square::SquareLayout readSquare(YamlMap map) {
  square::SquareLayout square;
  square.side_x = map.get<double>("side_x");
  square.side_y = map.get<double>("side_y");
  square.led_height = map.get<double>("led_height");
  square.origin = readVector(map, "origin", 2);
  square.yaw = map.get<double>("yaw");
  if (map.has("lengths")) {
    for (YamlMap& taped : map.maps("lengths")) {
      const auto from = taped.bounded<std::size_t>("from", 1, 4) - 1;
      const auto to = taped.bounded<std::size_t>("to", 1, 4) - 1;
      square.lengths.push_back(
          {from, to, taped.get<double>("length"), taped.get<double>("stddev")});
      taped.refuseUnknown();
    }
  }
  if (map.has("places")) {
    for (YamlMap& place : map.maps("places")) {
      square.places.push_back({place.vector("position"), place.get<double>("stddev")});
      place.refuseUnknown();
    }
  }
  map.refuseUnknown();
  return square;
}

wave::Wand readWand(YamlMap map) {
  wave::Wand wand;
  wand.length = map.get<double>("length");
  wand.stddev = map.get<double>("stddev");
  if (map.has("led_height"))
    wand.led_height = map.get<double>("led_height");
  map.refuseUnknown();
  return wand;
}

geometry::Intrinsics readLens(YamlMap map) {
  constexpr int kLargest = std::numeric_limits<int>::max();
  geometry::Intrinsics lens;
  lens.width = map.bounded("width", 1, kLargest);
  lens.height = map.bounded("height", 1, kLargest);
  lens.fx = map.get<double>("fx");
  lens.fy = map.get<double>("fy");
  lens.cx = map.get<double>("cx");
  lens.cy = map.get<double>("cy");
  const auto model = geometry::distortionModelFromName(map.get<std::string>("distortion_model"));
  if (!model)
    throw map.error("distortion_model", "must be " + geometry::describeDistortionModels());
  lens.distortion_model = *model;
  const std::vector<double> distortion =
      map.numbers("distortion", geometry::coefficientCount(*model));
  std::copy(distortion.begin(), distortion.end(), lens.distortion.begin());
  map.refuseUnknown();
  return lens;
}

/// @param pixels as many as the list must have.
template <typename Pixels>
void readPixels(YamlMap& map, const std::string& key, const std::string& count, Pixels* pixels) {
  const auto list = map.get<std::vector<YAML::Node>>(key);
  bool good = list.size() == pixels->size();
  for (std::size_t c = 0; good && c < list.size(); ++c) {
    if (list[c].IsNull())
      continue;
    good = list[c].IsSequence() && list[c].size() == 2;
    double x = 0.0;
    double y = 0.0;
    good = good && YAML::convert<double>::decode(list[c][0], x) &&
           YAML::convert<double>::decode(list[c][1], y);
    (*pixels)[c] = Eigen::Vector2d(x, y);
  }
  if (!good)
    throw map.error(key, "is not a list of " + count + " places, each two numbers or null");
}

void readCamera(YamlMap map, SamplesHead* head) {
  wave::CameraRecording camera;
  square::CameraSightings& sightings = camera.sightings;
  sightings.name = map.get<std::string>("name");
  sightings.identity = map.get<std::string>("identity");
  sightings.intrinsics = readLens(map.map("lens"));
  if (!map.get<YAML::Node>("gravity").IsNull())
    sightings.gravity = Eigen::Vector3d(readVector(map, "gravity", 3));
  camera.clock_epoch =
      map.bounded<std::uint32_t>("clock_epoch", 0, std::numeric_limits<std::uint32_t>::max());
  readPixels(map, "corners", "four", &sightings.corners);
  if (map.has("places")) {
    sightings.places.resize(
        head->samples.recording.square ? head->samples.recording.square->places.size() : 0);
    readPixels(map, "places", "the square's", &sightings.places);
  }
  for (YamlMap& mask : map.maps("masks")) {
    const Eigen::Vector2d center = readVector(mask, "center", 2);
    camera.masks.push_back({center, mask.get<double>("radius")});
    mask.refuseUnknown();
  }
  head->frames.push_back(
      map.bounded<std::size_t>("frames", 0, std::numeric_limits<std::int32_t>::max()));
  map.refuseUnknown();
  head->samples.recording.cameras.push_back(camera);
}

}  // namespace

std::string yamlFromSamples(const Samples& samples) {
  YAML::Emitter out;
  out << YAML::Comment("What was captured to calibrate a rig; units as in doc/samples.md.");
  out << YAML::BeginMap;
  out << YAML::Key << "format" << YAML::Value << kFormat;
  out << YAML::Key << "version" << YAML::Value << kVersion;
  out << YAML::Key << "world_frame" << YAML::Value << YAML::DoubleQuoted << samples.world_frame;
  emitSquare(samples.recording.square, out);
  emitWand(samples.recording.wand, out);
  out << YAML::Key << "cameras" << YAML::Value << YAML::BeginSeq;
  for (const wave::CameraRecording& camera : samples.recording.cameras)
    emitCamera(camera, out);
  out << YAML::EndSeq << YAML::EndMap;
  return out.c_str();
}

SamplesHead headFromYaml(const std::string& text, const std::string& where) {
  YamlMap map = YamlMap::parse(text, where, "choose a file that save_samples wrote");
  map.checkFormat(kFormat, kVersion);
  SamplesHead head;
  head.samples.world_frame = map.get<std::string>("world_frame");
  if (!map.get<YAML::Node>("square").IsNull())
    head.samples.recording.square = readSquare(map.map("square"));
  if (!map.get<YAML::Node>("wand").IsNull())
    head.samples.recording.wand = readWand(map.map("wand"));
  for (const YamlMap& camera : map.maps("cameras"))
    readCamera(camera, &head);
  map.refuseUnknown();
  return head;
}

}  // namespace wiimote_tracker::samples
