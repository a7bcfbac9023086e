#include "samples_yaml.h"

#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/yaml_map.h>

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <limits>

namespace wiimote_tracker::samples {

namespace {

using geometry::YamlMap;

constexpr const char* kFormat = "wiimote_tracker_samples";
constexpr int kVersion = 1;

/// A list of whatever `emit` writes of each element.
template <typename List, typename Emit>
void emitList(const char* key, const List& list, YAML::Emitter& out, const Emit& emit) {
  out << key << YAML::BeginSeq;
  for (const auto& element : list)
    emit(element);
  out << YAML::EndSeq;
}

void emitSquare(const square::SquareLayout& square, YAML::Emitter& out) {
  out << YAML::BeginMap;
  out << "side_x" << exactNumber(square.side_x);
  out << "side_y" << exactNumber(square.side_y);
  out << "led_height" << exactNumber(square.led_height);
  out << "origin" << YAML::Flow << exactNumbers(square.origin);
  out << "yaw" << exactNumber(square.yaw);
  // Older programs refuse these keys.
  if (!square.lengths.empty())
    emitList("lengths", square.lengths, out, [&](const square::TapedLength& taped) {
      out << YAML::Flow << YAML::BeginMap << "from" << taped.from + 1 << "to" << taped.to + 1;
      out << "length" << exactNumber(taped.length);
      out << "stddev" << exactNumber(taped.stddev) << YAML::EndMap;
    });
  if (!square.places.empty())
    emitList("places", square.places, out, [&](const square::KnownPlace& place) {
      out << YAML::Flow << YAML::BeginMap << "position" << exactNumbers(place.position);
      out << "stddev" << exactNumber(place.stddev) << YAML::EndMap;
    });
  out << YAML::EndMap;
}

void emitWand(const wave::Wand& wand, YAML::Emitter& out) {
  out << YAML::BeginMap;
  out << "length" << exactNumber(wand.length);
  out << "stddev" << exactNumber(wand.stddev);
  if (wand.led_height)  // older programs refuse this key
    out << "led_height" << exactNumber(*wand.led_height);
  out << YAML::EndMap;
}

void emitLens(const geometry::Intrinsics& lens, YAML::Emitter& out) {
  const Eigen::Map<const Eigen::VectorXd> distortion(
      lens.distortion.data(),
      static_cast<Eigen::Index>(geometry::coefficientCount(lens.distortion_model)));
  out << YAML::BeginMap << "width" << lens.width << "height" << lens.height;
  out << "fx" << exactNumber(lens.fx) << "fy" << exactNumber(lens.fy);
  out << "cx" << exactNumber(lens.cx) << "cy" << exactNumber(lens.cy);
  out << "distortion_model" << geometry::nameOf(lens.distortion_model);
  out << "distortion" << YAML::Flow << exactNumbers(distortion) << YAML::EndMap;
}

void emitCamera(const wave::CameraRecording& camera, YAML::Emitter& out) {
  const square::CameraSightings& sightings = camera.sightings;
  const auto emitNumbers = [&](const auto& numbers) {
    if (numbers)
      out << YAML::Flow << exactNumbers(*numbers);
    else
      out << YAML::Null;
  };
  out << YAML::BeginMap;
  out << "name" << YAML::DoubleQuoted << sightings.name;
  out << "identity" << YAML::DoubleQuoted << sightings.identity;
  out << "lens";
  emitLens(sightings.intrinsics, out);
  out << "gravity";
  emitNumbers(sightings.gravity);
  out << "clock_epoch" << camera.clock_epoch;
  emitList("corners", sightings.corners, out, emitNumbers);
  if (!sightings.places.empty())
    emitList("places", sightings.places, out, emitNumbers);
  emitList("masks", camera.masks, out, [&](const geometry::ImageMask& mask) {
    out << YAML::Flow << YAML::BeginMap << "center" << exactNumbers(mask.center);
    out << "radius" << exactNumber(mask.radius) << YAML::EndMap;
  });
  out << "frames" << camera.frames.size() << YAML::EndMap;
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
    }
  }
  if (map.has("places")) {
    for (YamlMap& place : map.maps("places"))
      square.places.push_back({place.vector("position"), place.get<double>("stddev")});
  }
  return square;
}

wave::Wand readWand(YamlMap map) {
  wave::Wand wand;
  wand.length = map.get<double>("length");
  wand.stddev = map.get<double>("stddev");
  if (map.has("led_height"))
    wand.led_height = map.get<double>("led_height");
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
  }
  head->frames.push_back(
      map.bounded<std::size_t>("frames", 0, std::numeric_limits<std::int32_t>::max()));
  head->samples.recording.cameras.push_back(camera);
}

}  // namespace

std::string yamlFromSamples(const Samples& samples) {
  const wave::Recording& recording = samples.recording;
  YAML::Emitter out;
  out << YAML::Comment("What was captured to calibrate a rig; units as in doc/samples.md.");
  out << YAML::BeginMap << "format" << kFormat << "version" << kVersion;
  out << "world_frame" << YAML::DoubleQuoted << samples.world_frame;
  out << "square";
  if (recording.square)
    emitSquare(*recording.square, out);
  else
    out << YAML::Null;
  out << "wand";
  if (recording.wand)
    emitWand(*recording.wand, out);
  else
    out << YAML::Null;
  emitList("cameras", recording.cameras, out,
           [&](const wave::CameraRecording& camera) { emitCamera(camera, out); });
  out << YAML::EndMap;
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
