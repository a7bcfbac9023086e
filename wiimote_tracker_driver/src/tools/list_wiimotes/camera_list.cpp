#include "camera_list.h"

#include "transport/transport.h"

#include <wiimote_tracker_msgs/text.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

namespace wiimote_tracker::list_wiimotes {
namespace {

constexpr char kPrefix[] = "wiimote_";

bool isBlankOrComment(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  return first == std::string::npos || line[first] == '#';
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    lines.push_back(line);
  return lines;
}

/// Refuses YAML at `mark`. `what_to_do`: advice for the user.
[[noreturn]] void refuse(const YAML::Mark& mark,
                         const std::vector<std::string>& lines,
                         const std::string& what_to_do) {
  const auto line = static_cast<std::size_t>(std::max(0, mark.line));
  throw CameraListError("line " + std::to_string(line + 1) + " is '" +
                        (line < lines.size() ? lines[line] : "") + "': " + what_to_do);
}

YAML::Node load(const std::string& text, const std::vector<std::string>& lines) {
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception& e) {
    refuse(e.mark, lines, "this is not YAML (" + e.msg + "); correct it");
  }
}

/// Refuses a key of a mapping that is there twice.
void refuseRepeated(const YAML::Node& mapping, const std::vector<std::string>& lines) {
  std::set<std::string> seen;
  for (const auto& pair : mapping) {
    const std::string key = pair.first.as<std::string>("");
    if (!seen.insert(key).second)
      refuse(pair.first.Mark(), lines, key + " is there twice; remove one of them");
  }
}

/// Refuses what may not stand beside "cameras:".
void checkFile(const YAML::Node& file, const std::vector<std::string>& lines) {
  refuseRepeated(file, lines);
  for (const auto& pair : file) {
    const YAML::Mark mark = pair.first.Mark();
    const std::string key = pair.first.as<std::string>("");
    if (key != "cameras" && key != "discover")
      refuse(mark, lines, "only \"discover:\" and \"cameras:\" are allowed here");
    if (key == "cameras")
      continue;
    bool discover = false;
    if (!YAML::convert<bool>::decode(pair.second, discover))
      refuse(mark, lines, "\"discover\" must be true or false");
    if (mark.line > file["cameras"].Mark().line)
      refuse(mark, lines, "write it above \"cameras:\"");
  }
}

/// Refuses what a camera may not have.
void checkCamera(const YAML::Node& camera, const std::vector<std::string>& lines) {
  refuseRepeated(camera, lines);
  for (const auto& pair : camera) {
    const std::string key = pair.first.as<std::string>("");
    if (key != "identity" && key != "driver")
      refuse(
          pair.first.Mark(), lines,
          "a camera may have \"identity:\" and \"driver:\", and the parameters below the latter");
    if (key == "driver" && !pair.second.IsMap() && !pair.second.IsNull())
      refuse(pair.first.Mark(), lines, "\"driver:\" must have lines \"parameter: value\"");
  }
}

/// Whether PyYAML, by which `drivers` reads the list, takes it for a number, also of base 60.
bool isNumber(const std::string& text) {
  return std::regex_match(text, std::regex("[1-9][0-9]*(:[0-5]?[0-9])*"));
}

bool isDevice(const std::string& text) {
  try {
    transport::parseDeviceName(text);
    return true;
  } catch (const transport::BadDeviceName&) {
    return false;
  }
}

}  // namespace

CameraList::CameraList()
    : CameraList(
          "# The Wii Remotes of a rig: name of the camera (its namespace and the prefix of its "
          "frames) and the\n# Bluetooth address.\ncameras:\n") {}

CameraList::CameraList(const std::string& text) : lines_(linesOf(text)) {
  const YAML::Node file = load(text, lines_);
  if (!file.IsMap() || !file["cameras"])
    throw CameraListError("there is no line \"cameras:\": write one above the cameras");
  checkFile(file, lines_);
  const YAML::Node cameras = file["cameras"];
  if (cameras.IsNull())
    return;
  if (!cameras.IsMap() || cameras.Style() == YAML::EmitterStyle::Flow)
    refuse(cameras.Mark(), lines_, "write one line  name: \"address\"  for each camera");
  refuseRepeated(cameras, lines_);
  for (const auto& pair : cameras) {
    const YAML::Mark mark = pair.first.Mark();
    Camera camera;
    camera.name = pair.first.as<std::string>("");
    if (!isWord(camera.name))
      refuse(mark, lines_, "a camera's name must be letters, digits and _, a letter first");
    if (pair.second.IsMap())
      checkCamera(pair.second, lines_);
    const YAML::Node device = pair.second.IsMap() ? pair.second["identity"] : pair.second;
    if (!device || !device.IsScalar() || device.Scalar().empty())
      refuse(mark, lines_,
             "camera " + camera.name + " has no device: write  identity: \"address\"  below it");
    camera.device = device.Scalar();
    camera.line = static_cast<std::size_t>(device.Mark().line);
    camera.begin = static_cast<std::size_t>(device.Mark().column);
    const std::string& line = lines_[camera.line];
    const bool quoted = line[camera.begin] == '"' || line[camera.begin] == '\'';
    camera.size = camera.device.size() + (quoted ? 2 : 0);
    if (line.compare(camera.begin + (quoted ? 1 : 0), camera.device.size(), camera.device) != 0)
      refuse(device.Mark(), lines_, "write the address in quotes on one line");
    if (!quoted && isNumber(camera.device))
      refuse(device.Mark(), lines_, "write the address in quotes: YAML takes it for a number");
    indent_.assign(static_cast<std::size_t>(mark.column), ' ');
    cameras_.push_back(camera);
  }
}

std::string CameraList::nameOf(const std::string& device) const {
  for (const Camera& camera : cameras_) {
    if (lowerCase(camera.device) == lowerCase(device))
      return camera.name;
  }
  return "";
}

const CameraList::Camera* CameraList::find(const std::string& name) const {
  const auto camera = std::find_if(cameras_.begin(), cameras_.end(),
                                   [&](const Camera& c) { return c.name == name; });
  return camera == cameras_.end() ? nullptr : &*camera;
}

void CameraList::replace(const std::string& name, const std::string& device) {
  const Camera* const camera = find(name);
  if (camera == nullptr) {
    std::string names;
    for (const Camera& other : cameras_)
      names += (names.empty() ? "" : ", ") + other.name;
    throw CameraListError("there is no camera '" + name + "': choose one of: " + names);
  }
  lines_[camera->line].replace(camera->begin, camera->size, '"' + device + '"');
  *this = CameraList(text());
}

std::string CameraList::add(const std::string& device) {
  int number = 1;
  while (find(kPrefix + std::to_string(number)) != nullptr)
    ++number;
  const std::string name = kPrefix + std::to_string(number);
  // Below the last camera, above the comments that follow it.
  const auto last = std::find_if_not(lines_.rbegin(), lines_.rend(), isBlankOrComment);
  lines_.insert(last.base(), indent_ + name + ": \"" + device + '"');
  *this = CameraList(text());
  if (find(name) == nullptr)  // it stands behind the end of the first YAML document
    throw CameraListError("a line \"...\" or a second \"---\" ends the list of cameras: remove it");
  return name;
}

std::string CameraList::text() const {
  std::string text;
  for (const std::string& line : lines_)
    text += line + '\n';
  return text;
}

std::vector<std::string> problems(const CameraList& list) {
  std::vector<std::string> sentences;
  for (const CameraList::Camera& camera : list.cameras()) {
    const std::string start = "camera " + camera.name + " has the device " + camera.device;
    const std::string owner = list.nameOf(camera.device);
    if (!isDevice(camera.device))
      sentences.push_back(
          start +
          ": give a Bluetooth address such as \"00:1f:32:12:34:56\", or a path such as "
          "/dev/hidraw0");
    else if (owner != camera.name)
      sentences.push_back(start + ", and so has camera " + owner + ": remove one of them");
  }
  return sentences;
}

CameraList readCameraList(const std::string& path) {
  std::ifstream file(path);
  file >> std::noskipws;
  const std::string text(std::istream_iterator<char>(file), {});  // an empty one is no error
  if (!file.is_open() || file.bad())
    throw CameraListError(path + " cannot be read (" + std::strerror(errno) +
                          "): correct the path of the cameras.yaml");
  try {
    return CameraList(text);
  } catch (const CameraListError& e) {
    throw CameraListError(path + ", " + e.what());
  }
}

void requireFile(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_other(status))
    throw CameraListError(path + " is a pipe, device or socket: give the path of a file");
}

void writeCameraList(const CameraList& list, const std::string& path) {
  namespace fs = std::filesystem;
  // A symbolic link is kept; its target is replaced.
  std::error_code error;
  const fs::path target = fs::exists(path) ? fs::canonical(path, error) : fs::path(path);
  const fs::path fresh = target.string() + ".new";
  {
    std::ofstream file(fresh);
    file << list.text();
    file.close();
    if (!file)
      throw CameraListError(fresh.string() + " cannot be written (" + std::strerror(errno) +
                            "): choose a folder that you may write to");
  }
  if (fs::exists(target))
    fs::copy_file(target, target.string() + ".bak", fs::copy_options::overwrite_existing, error);
  if (!error)
    fs::rename(fresh, target, error);
  if (error)
    throw CameraListError(path + " cannot be replaced (" + error.message() +
                          "): choose a folder that you may write to");
}

}  // namespace wiimote_tracker::list_wiimotes
