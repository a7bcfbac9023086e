#include "description.h"

#include "wiimote_tracker_triangulation/geometry/error.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <limits>
#include <set>
#include <sstream>

namespace wiimote_tracker::simulation {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// One mapping of the file. Knows its place, so that errors can name the key in full, and which
/// keys were read, so that a misspelt one is noticed.
class Section {
 public:
  Section(const YAML::Node& node, const std::string& file, const std::string& path)
      : node_(node), file_(file), path_(path) {
    if (!node_.IsMap())
      throw DescriptionError(file_ + ": " + (path_.empty() ? "the file" : path_) +
                             " must be a mapping of keys to values");
  }

  Section section(const std::string& key) { return Section(get(key), file_, name(key)); }

  bool has(const std::string& key) const { return static_cast<bool>(node_[key]); }

  template <typename T>
  T value(const std::string& key) {
    try {
      return get(key).as<T>();
    } catch (const YAML::Exception&) {
      throw error(key, "has the wrong type");
    }
  }

  template <typename T>
  T value(const std::string& key, const T& default_value) {
    return has(key) ? value<T>(key) : default_value;
  }

  double number(const std::string& key, double minimum, double maximum) {
    const double number = value<double>(key);
    if (minimum <= number && number <= maximum)  // false for NaN
      return number;
    std::ostringstream text;
    text << "is " << number << ", but must be within " << minimum << " and " << maximum;
    throw error(key, text.str());
  }

  double number(const std::string& key, double minimum, double maximum, double default_value) {
    return has(key) ? number(key, minimum, maximum) : default_value;
  }

  Eigen::Vector3d point(const std::string& key) {
    const auto values = value<std::vector<double>>(key);
    if (values.size() != 3)
      throw error(key, "must have three numbers: x, y, z");
    const Eigen::Vector3d point(values[0], values[1], values[2]);
    if (!point.allFinite())
      throw error(key, "must be finite");
    return point;
  }

  /// Names and contents of the mappings in this one, in the order of the file.
  std::vector<std::pair<std::string, Section>> entries() {
    std::vector<std::pair<std::string, Section>> entries;
    for (const auto& entry : node_) {
      const auto key = entry.first.as<std::string>();
      read_.insert(key);
      for (const auto& other : entries) {
        if (other.first == key)
          throw error(key, "is there twice");
      }
      entries.emplace_back(key, Section(entry.second, file_, name(key)));
    }
    if (entries.empty())
      throw DescriptionError(file_ + ": " + path_ + " is empty; describe at least one");
    return entries;
  }

  void refuseUnknown() const {
    for (const auto& entry : node_) {
      const auto key = entry.first.as<std::string>();
      if (read_.count(key) == 0)
        throw error(key, "is not known; remove it or correct its spelling");
    }
  }

  DescriptionError error(const std::string& key, const std::string& what) const {
    return DescriptionError(file_ + ": " + name(key) + " " + what);
  }

 private:
  std::string name(const std::string& key) const { return path_.empty() ? key : path_ + "/" + key; }

  YAML::Node get(const std::string& key) {
    read_.insert(key);
    if (!has(key))
      throw error(key, "is missing");
    return node_[key];
  }

  const YAML::Node node_;
  std::string file_;
  std::string path_;
  std::set<std::string> read_;
};

geometry::Intrinsics readIntrinsics(Section section) {
  geometry::Intrinsics intrinsics;
  intrinsics.width = section.value<int>("width", intrinsics.width);
  intrinsics.height = section.value<int>("height", intrinsics.height);
  intrinsics.fx = section.value<double>("fx");
  intrinsics.fy = section.value<double>("fy");
  intrinsics.cx = section.value<double>("cx");
  intrinsics.cy = section.value<double>("cy");
  const auto distortion = section.value<std::vector<double>>("distortion");
  if (distortion.size() != intrinsics.distortion.size())
    throw section.error("distortion", "must have five numbers: k1, k2, p1, p2, k3");
  std::copy(distortion.begin(), distortion.end(), intrinsics.distortion.begin());
  section.refuseUnknown();
  return intrinsics;
}

virtual_wiimote::FrameTimesModel readTiming(Section clock, Section delay) {
  using Core = virtual_wiimote::FrameTimesModel::Core;
  virtual_wiimote::FrameTimesModel timing;
  timing.period = clock.number("period", 0.001, 1.0);
  timing.period_tolerance = clock.number("tolerance", 0.0, 0.01, timing.period_tolerance);
  timing.phase = clock.number("phase", 0.0, 1.0);
  timing.wander = clock.number("wander", 0.0, 0.1, timing.wander);
  clock.refuseUnknown();
  timing.delay = delay.number("constant", 0.0, 1.0);
  timing.jitter = delay.number("jitter", 0.0, 1.0);
  const auto shape = delay.value<std::string>("shape", "hard_edge");
  if (shape != "hard_edge" && shape != "bell")
    throw delay.error("shape", "is " + shape + ", but must be hard_edge or bell");
  timing.core = shape == "bell" ? Core::kBell : Core::kHardEdge;
  timing.slot = delay.number("slot", 0.0, 0.1, timing.slot);
  timing.drops = delay.number("drops", 0.0, 0.9, timing.drops);
  timing.burst = delay.number("burst", 0.0, 0.99, timing.burst);
  timing.stalls = delay.number("stalls", 0.0, 10.0, timing.stalls);
  timing.longest_stall = delay.number("longest_stall", 0.0, 10.0, timing.longest_stall);
  delay.refuseUnknown();
  return timing;
}

CameraDescription readCamera(const std::string& name, Section section) {
  CameraDescription description;
  geometry::Camera& camera = description.camera;
  camera.name = name;
  camera.identity = section.value<std::string>("identity");
  camera.intrinsics = readIntrinsics(section.section("intrinsics"));
  try {
    camera.intrinsics.check();
  } catch (const geometry::Error& error) {
    throw section.error("intrinsics", std::string("cannot be used: ") + error.what());
  }
  const Eigen::Vector3d position = section.point("position");
  const Eigen::Vector3d target = section.point("look_at");
  try {
    camera.world_from_camera = geometry::lookAt(position, target, Eigen::Vector3d::UnitZ());
  } catch (const geometry::Error& error) {
    throw section.error("look_at", std::string("cannot be used: ") + error.what());
  }
  description.timing = readTiming(section.section("clock"), section.section("delay"));
  section.refuseUnknown();
  return description;
}

LedDescription readLed(const std::string& name, Section section) {
  LedDescription led;
  led.name = name;
  if (section.has("turns")) {
    Section turns = section.section("turns");
    led.turns =
        TurnDescription{turns.value<std::string>("around"), turns.number("distance", 0.001, 10.0),
                        turns.number("rate", 0.0, 100.0)};
    turns.refuseUnknown();
  } else {
    led.position = section.point("position");
  }
  if (section.has("size"))
    led.size = section.number("size", 0.0, 15.0);
  led.brightness = section.number("brightness", 0.0, kInfinity, led.brightness);
  led.lit = section.value<bool>("lit", led.lit);
  section.refuseUnknown();
  return led;
}

/// An LED turns about one that is there, and that does not turn itself.
void checkTurns(const std::string& name, Section section, const std::vector<LedDescription>& leds) {
  const auto find = [&leds](const std::string& wanted) {
    return std::find_if(leds.begin(), leds.end(),
                        [&](const LedDescription& led) { return led.name == wanted; });
  };
  const auto& turns = find(name)->turns;
  if (!turns)
    return;
  const auto around = find(turns->around);
  if (around == leds.end() || around->turns)
    throw section.error("turns/around", "must be the name of an LED that does not turn itself");
}

BoardDescription readBoard(Section section, const std::vector<CameraDescription>& cameras) {
  BoardDescription board;
  board.before = section.value<std::string>("before");
  if (std::none_of(cameras.begin(), cameras.end(), [&](const CameraDescription& camera) {
        return camera.camera.name == board.before;
      }))
    throw section.error("before", "must be the name of a camera");
  board.column_spacing = section.number("column_spacing", 0.001, 1.0, board.column_spacing);
  board.row_spacing = section.number("row_spacing", 0.001, 1.0, board.row_spacing);
  board.size = section.number("size", 0.0, 15.0, board.size);
  section.refuseUnknown();
  return board;
}

}  // namespace

Description readDescription(const std::string& path) {
  YAML::Node root;
  try {
    root = YAML::LoadFile(path);
  } catch (const YAML::BadFile&) {
    throw DescriptionError(path + ": cannot be read; give the path of a rig description");
  } catch (const YAML::Exception& error) {
    throw DescriptionError(path + ": is not valid YAML: " + error.what());
  }

  Section file(root, path, "");
  Description description;
  description.world_frame = file.value<std::string>("world_frame", description.world_frame);
  description.seed = static_cast<std::uint32_t>(file.number("seed", 0, 2147483647));
  description.pixel_noise = file.number("pixel_noise", 0.0, 100.0);
  description.truth_rate = file.number("truth_rate", 1.0, 10000.0, description.truth_rate);
  Section cameras = file.section("cameras");
  for (const auto& [name, section] : cameras.entries())
    description.cameras.push_back(readCamera(name, section));
  Section leds = file.section("leds");
  for (const auto& [name, section] : leds.entries())
    description.leds.push_back(readLed(name, section));
  for (auto& [name, section] : leds.entries())
    checkTurns(name, section, description.leds);
  if (file.has("board"))
    description.board = readBoard(file.section("board"), description.cameras);
  file.refuseUnknown();
  return description;
}

}  // namespace wiimote_tracker::simulation
