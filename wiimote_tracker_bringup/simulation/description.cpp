#include "description.h"

#include "wiimote_tracker_triangulation/geometry/yaml_map.h"
#include "wiimote_tracker_triangulation/gesture/path_file.h"
#include "wiimote_tracker_triangulation/identity/codes_file.h"
#include "wiimote_tracker_triangulation/identity/schemes.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

namespace wiimote_tracker::simulation {
namespace {

using geometry::YamlMap;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kLargestSeed = std::numeric_limits<std::int32_t>::max();

geometry::Intrinsics readIntrinsics(YamlMap section) {
  geometry::Intrinsics intrinsics;
  intrinsics.width = section.get<int>("width", intrinsics.width);
  intrinsics.height = section.get<int>("height", intrinsics.height);
  intrinsics.fx = section.get<double>("fx");
  intrinsics.fy = section.get<double>("fy");
  intrinsics.cx = section.get<double>("cx");
  intrinsics.cy = section.get<double>("cy");
  const auto model = geometry::distortionModelFromName(
      section.get<std::string>("distortion_model", geometry::nameOf(intrinsics.distortion_model)));
  if (!model)
    throw section.error("distortion_model", "must be " + geometry::describeDistortionModels());
  intrinsics.distortion_model = *model;
  const auto distortion = section.get<std::vector<double>>("distortion");
  if (distortion.size() != geometry::coefficientCount(*model))
    throw section.error("distortion",
                        std::string("must have the numbers ") + geometry::coefficientNames(*model));
  std::copy(distortion.begin(), distortion.end(), intrinsics.distortion.begin());
  return intrinsics;
}

virtual_wiimote::FrameTimesModel readTiming(YamlMap clock, YamlMap delay) {
  using Core = virtual_wiimote::FrameTimesModel::Core;
  virtual_wiimote::FrameTimesModel timing;
  timing.period = clock.bounded("period", 0.001, 1.0);
  timing.period_tolerance = clock.bounded("tolerance", 0.0, 0.01, timing.period_tolerance);
  timing.phase = clock.bounded("phase", 0.0, 1.0);
  timing.wander = clock.bounded("wander", 0.0, 0.1, timing.wander);
  timing.delay = delay.bounded("constant", 0.0, 1.0);
  timing.jitter = delay.bounded("jitter", 0.0, 1.0);
  const auto shape = delay.get<std::string>("shape", "exponential");
  if (shape != "exponential" && shape != "normal")
    throw delay.error("shape", "is " + shape + ", but must be exponential or normal");
  timing.core = shape == "normal" ? Core::kNormal : Core::kExponential;
  timing.slot = delay.bounded("slot", 0.0, 0.1, timing.slot);
  timing.drops = delay.bounded("drops", 0.0, 0.9, timing.drops);
  timing.burst = delay.bounded("burst", 0.0, 0.99, timing.burst);
  timing.stalls = delay.bounded("stalls", 0.0, 10.0, timing.stalls);
  timing.longest_stall = delay.bounded("longest_stall", 0.0, 10.0, timing.longest_stall);
  return timing;
}

CameraDescription readCamera(const std::string& name, YamlMap section) {
  CameraDescription description;
  geometry::Camera& camera = description.camera;
  camera.name = name;
  camera.identity = section.get<std::string>("identity");
  camera.intrinsics = readIntrinsics(section.map("intrinsics"));
  try {
    camera.intrinsics.check();
  } catch (const Error& error) {
    throw section.error("intrinsics", std::string("cannot be used: ") + error.what());
  }
  const Eigen::Vector3d position = section.vector("position");
  const Eigen::Vector3d target = section.vector("look_at");
  try {
    camera.world_from_camera = geometry::lookAt(position, target, Eigen::Vector3d::UnitZ());
  } catch (const Error& error) {
    throw section.error("look_at", std::string("cannot be used: ") + error.what());
  }
  description.timing = readTiming(section.map("clock"), section.map("delay"));
  return description;
}

/// Position of a still LED, or its wave or circle from the start on.
LedMotion readMotion(YamlMap* section) {
  LedMotion motion(section->vector("position"));
  if (section->has("wave") && section->has("circle"))
    throw section->error("circle", "and wave exclude each other; remove one of them");
  if (section->has("wave")) {
    YamlMap wave = section->map("wave");
    const Eigen::Vector3d box = wave.vector("box");
    if (!(box.minCoeff() >= 0.0 && box.maxCoeff() > 0.0))
      throw wave.error("box", "must have sides of 0 or more, and one of more than 0");
    motion.wave(0.0, wave.vector("middle"), box, wave.bounded("speed", 0.001, 100.0),
                wave.bounded<std::uint32_t>("path", 0, kLargestSeed));
  }
  if (section->has("circle")) {
    YamlMap circle = section->map("circle");
    const double radius = circle.bounded("radius", 0.001, 100.0);
    motion.circle(0.0, circle.vector("middle"), radius, circle.bounded("speed", 0.001, 100.0));
  }
  return motion;
}

/// Size, brightness and switch of a light.
template <typename Shining>
void readLight(YamlMap* section, Shining* shining) {
  if (section->has("size"))
    shining->size = section->bounded("size", 0.0, 15.0);
  shining->brightness = section->bounded("brightness", 0.0, kInfinity, shining->brightness);
  shining->lit = section->get<bool>("lit", shining->lit);
}

/// Why a file that the description names cannot be used.
std::string unusable(const std::filesystem::path& file, const Error& error) {
  std::error_code ignored;
  return std::string("cannot be used: ") + error.what() +
         (std::filesystem::exists(file, ignored)
              ? ""
              : "; paths begin at the folder of the description: copy this file there, too");
}

/// The one code of a word of chips.
identity::BlinkCodes codesOfWord(YamlMap* section) {
  const std::vector<identity::CyclicLed> leds = {{"led", section->get<std::string>("word")}};
  const double chip = section->bounded("chip", 0.001, 1.0);
  try {
    return identity::cyclicCodes(leds, chip, 0.0);
  } catch (const Error& error) {
    throw section->error("word", std::string("cannot be used: ") + error.what());
  }
}

/// A file of codes, relative to `folder`.
identity::BlinkCodes codesOfFile(const std::filesystem::path& folder, YamlMap* section) {
  const std::filesystem::path file = folder / section->get<std::string>("codes");
  try {
    return identity::readBlinkCodes(file.string());
  } catch (const Error& error) {
    throw section->error("codes", unusable(file, error));
  }
}

/// A label of a file of codes, relative to `folder`, or a word of chips.
Blink readBlink(YamlMap section, const std::filesystem::path& folder) {
  const bool is_word = section.has("word");
  const identity::BlinkCodes codes =
      is_word ? codesOfWord(&section) : codesOfFile(folder, &section);
  const auto label = is_word ? codes.codes.front().label : section.get<std::string>("label");
  const auto code =
      std::find_if(codes.codes.begin(), codes.codes.end(),
                   [&](const identity::BlinkCode& other) { return other.label == label; });
  if (code == codes.codes.end())
    throw section.error("label", "must be a label of the file of codes");
  Blink blink;
  blink.waveform = code->waveform;
  blink.period = section.bounded("period", codes.shortest_period, codes.longest_period,
                                 0.5 * (codes.shortest_period + codes.longest_period));
  blink.begin = section.bounded("begin", -1e6, 1e6, blink.begin);
  return blink;
}

LedDescription readLed(const std::string& name,
                       YamlMap section,
                       const std::filesystem::path& folder) {
  LedDescription led;
  led.name = name;
  if (section.has("turns")) {
    YamlMap turns = section.map("turns");
    led.turns =
        TurnDescription{turns.get<std::string>("around"), turns.bounded("distance", 0.001, 10.0),
                        turns.bounded("rate", 0.0, 100.0)};
  } else {
    led.motion = readMotion(&section);
    led.carried_by = section.get<std::string>("carried_by", "");
  }
  readLight(&section, &led);
  if (section.has("blink"))
    led.blink = readBlink(section.map("blink"), folder);
  return led;
}

PersonDescription readPerson(const std::string& name, YamlMap section) {
  PersonDescription person;
  person.name = name;
  person.motion = readMotion(&section);
  person.turn_rate = section.bounded("turn_rate", -100.0, 100.0, person.turn_rate);
  person.radius = section.bounded("radius", 0.001, 10.0, person.radius);
  person.height = section.bounded("height", 0.001, 10.0, person.height);
  person.present = section.get<bool>("present", person.present);
  return person;
}

RigidBodyDescription readBody(const std::string& name, YamlMap section) {
  RigidBodyDescription body;
  body.name = name;
  body.motion = readMotion(&section);
  TurningDescription& turning = body.turning;
  if (section.has("turn")) {
    YamlMap turn = section.map("turn");
    turning.axis = turn.vector("axis");
    if (!(turning.axis.norm() > 0.0))
      throw turn.error("axis", "must have a direction");
    turning.rate = turn.bounded("rate", -100.0, 100.0);
  }
  if (section.has("sway")) {
    YamlMap sway = section.map("sway");
    turning.sway = sway.bounded("angle", 0.0, 3.2);
    turning.sway_rate = sway.bounded("rate", 0.0, 100.0);
  }
  body.present = section.get<bool>("present", body.present);
  return body;
}

bool hasCamera(const Description& description, const std::string& name) {
  return std::any_of(description.cameras.begin(), description.cameras.end(),
                     [&](const CameraDescription& camera) { return camera.camera.name == name; });
}

ReflectionDescription readReflection(const std::string& name,
                                     YamlMap section,
                                     const Description& description) {
  ReflectionDescription reflection;
  reflection.name = name;
  reflection.camera = section.get<std::string>("camera");
  if (!hasCamera(description, reflection.camera))
    throw section.error("camera", "must be the name of a camera");
  const auto pixel = section.get<std::vector<double>>("pixel");
  if (pixel.size() != 2 || !std::isfinite(pixel[0]) || !std::isfinite(pixel[1]))
    throw section.error("pixel", "must have two numbers: u, v");
  reflection.pixel = {pixel[0], pixel[1]};
  readLight(&section, &reflection);
  return reflection;
}

/// @param folder to which the file's name is relative.
Drawing readDrawing(YamlMap section, const std::filesystem::path& folder) {
  const auto file = section.get<std::string>("file");
  const double size = section.bounded("size", 0.001, 100.0);
  const double rest = section.bounded("rest", 0.0, 60.0, 0.0);
  try {
    return Drawing(gesture::readPath((folder / file).string()), size, rest);
  } catch (const Error& error) {
    throw section.error("file", unusable(folder / file, error));
  } catch (const std::invalid_argument& error) {
    throw section.error("file", error.what());
  }
}

/// The named entries of a group, at least one.
std::vector<std::pair<std::string, YamlMap>> entriesOf(YamlMap* file, const std::string& group) {
  auto entries = file->map(group).entries();
  if (entries.empty())
    throw file->error(group, "is empty; describe at least one");
  return entries;
}

/// Reads a group. Names must be unique, because simulation/set_led identifies all things by name.
template <typename Thing, typename Read>
void readGroup(YamlMap* file,
               const std::string& group,
               std::set<std::string>* names,
               std::vector<Thing>* things,
               const Read& read) {
  for (const auto& [name, section] : entriesOf(file, group)) {
    if (!names->insert(name).second)
      throw file->error(group + "/" + name,
                        "is also the name of something else; rename one of them");
    things->push_back(read(name, section));
  }
}

/// Checks that LEDs turn about existing LEDs that do not turn, and that carriers exist.
void checkHolders(const Description& description, const YamlMap& file) {
  for (const LedDescription& led : description.leds) {
    const std::string key = "leds/" + led.name;
    if (led.turns) {
      const LedDescription* around = findNamed(description.leds, led.turns->around);
      if (!around || around->turns)
        throw file.error(key + "/turns/around",
                         "must be the name of an LED that does not turn itself");
    }
    if (!led.carried_by.empty() && !findNamed(description.people, led.carried_by) &&
        !findNamed(description.bodies, led.carried_by))
      throw file.error(key + "/carried_by", "must be the name of one of the people or bodies");
  }
}

BoardDescription readBoard(YamlMap section, const Description& description) {
  BoardDescription board;
  board.before = section.get<std::string>("before");
  if (!hasCamera(description, board.before))
    throw section.error("before", "must be the name of a camera");
  board.column_spacing = section.bounded("column_spacing", 0.001, 1.0, board.column_spacing);
  board.row_spacing = section.bounded("row_spacing", 0.001, 1.0, board.row_spacing);
  board.size = section.bounded("size", 0.0, 15.0, board.size);
  return board;
}

}  // namespace

Description readDescription(const std::string& path) {
  YamlMap file = YamlMap::load(path, "correct the description of the rig");
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  Description description;
  description.world_frame = file.get<std::string>("world_frame", description.world_frame);
  description.seed = file.bounded<std::uint32_t>("seed", 0, kLargestSeed);
  description.pixel_noise = file.bounded("pixel_noise", 0.0, 100.0);
  description.truth_rate = file.bounded("truth_rate", 1.0, 10000.0, description.truth_rate);
  for (const auto& [name, section] : entriesOf(&file, "cameras"))
    description.cameras.push_back(readCamera(name, section));
  std::set<std::string> names = {"board"};
  readGroup(&file, "leds", &names, &description.leds,
            [&](const auto& name, const auto& led) { return readLed(name, led, folder); });
  if (file.has("people"))
    readGroup(&file, "people", &names, &description.people, readPerson);
  if (file.has("bodies"))
    readGroup(&file, "bodies", &names, &description.bodies, readBody);
  checkHolders(description, file);
  if (file.has("reflections"))
    readGroup(&file, "reflections", &names, &description.reflections,
              [&](const auto& name, const auto& section) {
                return readReflection(name, section, description);
              });
  if (file.has("board"))
    description.board = readBoard(file.map("board"), description);
  if (file.has("drawings")) {
    for (const auto& [name, section] : entriesOf(&file, "drawings"))
      description.drawings.emplace(name, readDrawing(section, folder));
  }
  file.refuseUnknown();
  return description;
}

}  // namespace wiimote_tracker::simulation
