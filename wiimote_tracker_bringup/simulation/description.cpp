#include "description.h"

#include "section.h"

#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/gesture/error.h"
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

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

/// Where something lies, or that it is waved or circles from the beginning on.
LedMotion readMotion(Section* section) {
  LedMotion motion(section->point("position"));
  if (section->has("wave") && section->has("circle"))
    throw section->error("circle", "and wave exclude each other; remove one of them");
  if (section->has("wave")) {
    Section wave = section->section("wave");
    const Eigen::Vector3d box = wave.point("box");
    if (!(box.minCoeff() >= 0.0 && box.maxCoeff() > 0.0))
      throw wave.error("box", "must have sides of 0 or more, and one of more than 0");
    motion.wave(0.0, wave.point("middle"), box, wave.number("speed", 0.001, 100.0),
                static_cast<std::uint32_t>(wave.number("path", 0, 2147483647)));
    wave.refuseUnknown();
  }
  if (section->has("circle")) {
    Section circle = section->section("circle");
    const double radius = circle.number("radius", 0.001, 100.0);
    motion.circle(0.0, circle.point("middle"), radius, circle.number("speed", 0.001, 100.0));
    circle.refuseUnknown();
  }
  return motion;
}

/// Size, brightness and switch of anything that shines.
template <typename Shining>
void readLight(Section* section, Shining* shining) {
  if (section->has("size"))
    shining->size = section->number("size", 0.0, 15.0);
  shining->brightness = section->number("brightness", 0.0, kInfinity, shining->brightness);
  shining->lit = section->value<bool>("lit", shining->lit);
}

/// A label of a file of codes, whose name counts from `folder`; or a word of chips.
Blink readBlink(Section section, const std::filesystem::path& folder) {
  Blink blink;
  const std::string key = section.has("word") ? "word" : "codes";
  try {
    identity::BlinkCodes codes;
    std::string label = "led";
    if (section.has("word")) {
      codes = identity::cyclicCodes({{label, section.value<std::string>("word")}},
                                    section.number("chip", 0.001, 1.0), 0.0);
    } else {
      codes = identity::readBlinkCodes((folder / section.value<std::string>("codes")).string());
      label = section.value<std::string>("label");
    }
    const auto code =
        std::find_if(codes.codes.begin(), codes.codes.end(),
                     [&](const identity::BlinkCode& other) { return other.label == label; });
    if (code == codes.codes.end())
      throw section.error("label", "must be one of those in the file of codes");
    blink.waveform = code->waveform;
    blink.period = section.number("period", codes.shortest_period, codes.longest_period,
                                  0.5 * (codes.shortest_period + codes.longest_period));
  } catch (const geometry::Error& error) {
    throw section.error(key, std::string("cannot be used: ") + error.what());
  }
  blink.begin = section.number("begin", -1e6, 1e6, blink.begin);
  section.refuseUnknown();
  return blink;
}

LedDescription readLed(const std::string& name,
                       Section section,
                       const std::filesystem::path& folder) {
  LedDescription led;
  led.name = name;
  if (section.has("turns")) {
    Section turns = section.section("turns");
    led.turns =
        TurnDescription{turns.value<std::string>("around"), turns.number("distance", 0.001, 10.0),
                        turns.number("rate", 0.0, 100.0)};
    turns.refuseUnknown();
  } else {
    led.motion = readMotion(&section);
    led.carried_by = section.value<std::string>("carried_by", "");
  }
  readLight(&section, &led);
  if (section.has("blink"))
    led.blink = readBlink(section.section("blink"), folder);
  section.refuseUnknown();
  return led;
}

PersonDescription readPerson(const std::string& name, Section section) {
  PersonDescription person;
  person.name = name;
  person.motion = readMotion(&section);
  person.turn_rate = section.number("turn_rate", -100.0, 100.0, person.turn_rate);
  person.radius = section.number("radius", 0.001, 10.0, person.radius);
  person.height = section.number("height", 0.001, 10.0, person.height);
  person.present = section.value<bool>("present", person.present);
  section.refuseUnknown();
  return person;
}

RigidBodyDescription readBody(const std::string& name, Section section) {
  RigidBodyDescription body;
  body.name = name;
  body.motion = readMotion(&section);
  TurningDescription& turning = body.turning;
  if (section.has("turn")) {
    Section turn = section.section("turn");
    turning.axis = turn.point("axis");
    if (!(turning.axis.norm() > 0.0))
      throw turn.error("axis", "must have a direction");
    turning.rate = turn.number("rate", -100.0, 100.0);
    turn.refuseUnknown();
  }
  if (section.has("sway")) {
    Section sway = section.section("sway");
    turning.sway = sway.number("angle", 0.0, 3.2);
    turning.sway_rate = sway.number("rate", 0.0, 100.0);
    sway.refuseUnknown();
  }
  body.present = section.value<bool>("present", body.present);
  section.refuseUnknown();
  return body;
}

ReflectionDescription readReflection(const std::string& name, Section section) {
  ReflectionDescription reflection;
  reflection.name = name;
  reflection.camera = section.value<std::string>("camera");
  const auto pixel = section.value<std::vector<double>>("pixel");
  if (pixel.size() != 2 || !std::isfinite(pixel[0]) || !std::isfinite(pixel[1]))
    throw section.error("pixel", "must have two numbers: u, v");
  reflection.pixel = {pixel[0], pixel[1]};
  readLight(&section, &reflection);
  section.refuseUnknown();
  return reflection;
}

/// @param folder that the file's name counts from.
Drawing readDrawing(Section section, const std::filesystem::path& folder) {
  const auto file = section.value<std::string>("file");
  const double size = section.number("size", 0.001, 100.0);
  const double rest = section.number("rest", 0.0, 60.0, 0.0);
  section.refuseUnknown();
  try {
    return Drawing(gesture::readPath((folder / file).string()), size, rest);
  } catch (const gesture::GestureError& error) {
    throw section.error("file", std::string("cannot be used: ") + error.what());
  } catch (const std::invalid_argument& error) {
    throw section.error("file", error.what());
  }
}

bool hasCamera(const Description& description, const std::string& name) {
  return std::any_of(description.cameras.begin(), description.cameras.end(),
                     [&](const CameraDescription& camera) { return camera.camera.name == name; });
}

template <typename Things>
const typename Things::value_type* find(const Things& things, const std::string& name) {
  const auto found = std::find_if(things.begin(), things.end(),
                                  [&](const auto& thing) { return thing.name == name; });
  return found == things.end() ? nullptr : &*found;
}

/// An LED turns about one that is there, and that does not turn itself; who carries one is there.
void checkHolders(const std::string& name, const Section& section, const Description& description) {
  const LedDescription& led = *find(description.leds, name);
  if (led.turns) {
    const LedDescription* around = find(description.leds, led.turns->around);
    if (!around || around->turns)
      throw section.error("turns/around", "must be the name of an LED that does not turn itself");
  }
  if (!led.carried_by.empty() && !find(description.people, led.carried_by) &&
      !find(description.bodies, led.carried_by))
    throw section.error("carried_by", "must be the name of one of the people or bodies");
}

/// simulation/set_led knows all by their names.
template <typename Things>
void takeNames(const Things& things, const Section& section, std::set<std::string>* names) {
  for (const auto& thing : things) {
    if (!names->insert(thing.name).second)
      throw section.error(thing.name, "is the name of something else, too; give it another one");
  }
}

BoardDescription readBoard(Section section, const Description& description) {
  BoardDescription board;
  board.before = section.value<std::string>("before");
  if (!hasCamera(description, board.before))
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
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  Description description;
  description.world_frame = file.value<std::string>("world_frame", description.world_frame);
  description.seed = static_cast<std::uint32_t>(file.number("seed", 0, 2147483647));
  description.pixel_noise = file.number("pixel_noise", 0.0, 100.0);
  description.truth_rate = file.number("truth_rate", 1.0, 10000.0, description.truth_rate);
  Section cameras = file.section("cameras");
  for (const auto& [name, section] : cameras.entries())
    description.cameras.push_back(readCamera(name, section));
  std::set<std::string> names = {"board"};
  Section leds = file.section("leds");
  for (const auto& [name, section] : leds.entries())
    description.leds.push_back(readLed(name, section, folder));
  takeNames(description.leds, leds, &names);
  if (file.has("people")) {
    Section people = file.section("people");
    for (const auto& [name, section] : people.entries())
      description.people.push_back(readPerson(name, section));
    takeNames(description.people, people, &names);
  }
  if (file.has("bodies")) {
    Section bodies = file.section("bodies");
    for (const auto& [name, section] : bodies.entries())
      description.bodies.push_back(readBody(name, section));
    takeNames(description.bodies, bodies, &names);
  }
  for (const auto& [name, section] : leds.entries())
    checkHolders(name, section, description);
  if (file.has("reflections")) {
    Section reflections = file.section("reflections");
    for (const auto& [name, section] : reflections.entries()) {
      description.reflections.push_back(readReflection(name, section));
      if (!hasCamera(description, description.reflections.back().camera))
        throw section.error("camera", "must be the name of a camera");
    }
    takeNames(description.reflections, reflections, &names);
  }
  if (file.has("board"))
    description.board = readBoard(file.section("board"), description);
  if (file.has("drawings")) {
    Section drawings = file.section("drawings");
    for (const auto& [name, section] : drawings.entries())
      description.drawings.emplace(name, readDrawing(section, folder));
  }
  file.refuseUnknown();
  return description;
}

}  // namespace wiimote_tracker::simulation
