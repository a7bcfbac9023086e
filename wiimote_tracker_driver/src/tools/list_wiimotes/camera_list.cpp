#include "camera_list.h"

#include "yaml_line.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>

namespace wiimote_tracker::list_wiimotes {
namespace {

constexpr char kPrefix[] = "wiimote_";

std::string lowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool isCameraName(const std::string& key) {
  return std::isalpha(static_cast<unsigned char>(key[0])) != 0;
}

}  // namespace

CameraList::CameraList()
    : CameraList(
          "# The Wii Remotes of a rig: name of the camera (its namespace and the prefix of its "
          "frames) and the\n# Bluetooth address.\ncameras:\n") {}

CameraList::CameraList(const std::string& text) {
  bool in_cameras = false;
  std::set<std::string> names;
  std::string open;          // the camera whose name stands alone, with lines below it
  std::string inner_indent;  // of those lines
  bool open_has_device = true;

  std::istringstream stream(text);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    const auto refuse = [&](const std::string& what_to_do) {
      throw CameraListError("line " + std::to_string(number) + " is '" + line + "': " + what_to_do);
    };
    const auto closeCamera = [&] {
      if (!open_has_device)
        refuse("write  identity: \"address\"  below " + open + " first");
      open.clear();
    };
    Line parsed;
    parsed.text = line;
    const auto takeDevice = [&](const std::string& name, const Assignment& assignment) {
      parsed.entry = {name, assignment.value};
      parsed.key = assignment.before;
      parsed.comment = assignment.after;
    };
    const std::string indent = line.substr(0, line.find_first_not_of(" \t"));
    const std::optional<Assignment> assignment = parseAssignment(line);
    const bool is_discover =
        !in_cameras && indent.empty() && assignment && assignment->key == "discover";
    if (isBlankOrComment(line) || is_discover) {
      // stays as it is
    } else if (!in_cameras) {
      if (!assignment || assignment->key != "cameras" || !assignment->value.empty() ||
          !indent.empty())
        refuse("write \"cameras:\" above the cameras");
      in_cameras = true;
    } else if (!open.empty() && indent.size() > indent_.size()) {
      parsed.in_camera = true;
      if (inner_indent.empty())
        inner_indent = indent;
      if (indent == inner_indent && assignment && assignment->key == "identity" &&
          !assignment->value.empty()) {
        takeDevice(open, *assignment);
        open_has_device = true;
      }
    } else {
      closeCamera();
      parsed.in_camera = true;
      if (names.empty())
        indent_ = indent;
      if (!assignment || indent != indent_ || indent.empty())
        refuse("write one line  name: \"address\"  for each camera, indented alike");
      const std::string& name = assignment->key;
      if (!isCameraName(name))
        refuse("a camera's name must be letters, digits and _, a letter first");
      if (!names.insert(name).second)
        refuse("camera " + name + " is there already; remove one of the lines");
      const bool alone = assignment->value.empty();
      if (alone) {
        open = name;
        inner_indent.clear();
      } else {
        takeDevice(name, *assignment);
      }
      open_has_device = !alone;
    }
    lines_.push_back(parsed);
  }
  if (!in_cameras)
    throw CameraListError("there is no line \"cameras:\": write one above the cameras");
  if (!open_has_device)
    throw CameraListError("camera " + open +
                          " has no device: write  identity: \"address\"  below it");
}

std::vector<CameraList::Entry> CameraList::entries() const {
  std::vector<Entry> entries;
  for (const Line& line : lines_) {
    if (!line.entry.name.empty())
      entries.push_back(line.entry);
  }
  return entries;
}

std::string CameraList::nameOf(const std::string& device) const {
  for (const Line& line : lines_) {
    if (!line.entry.name.empty() && lowerCase(line.entry.device) == lowerCase(device))
      return line.entry.name;
  }
  return "";
}

CameraList::Line* CameraList::find(const std::string& name) {
  for (Line& line : lines_) {
    if (line.entry.name == name)
      return &line;
  }
  return nullptr;
}

void CameraList::replace(const std::string& name, const std::string& device) {
  Line* const line = name.empty() ? nullptr : find(name);
  if (line == nullptr) {
    std::string names;
    for (const Entry& entry : entries())
      names += (names.empty() ? "" : ", ") + entry.name;
    throw CameraListError("there is no camera '" + name + "': choose one of: " + names);
  }
  setDevice(*line, device);
}

void CameraList::setDevice(Line& line, const std::string& device) {
  line.entry.device = device;
  line.text = line.key + '"' + device + '"' + line.comment;
}

std::string CameraList::add(const std::string& device) {
  int number = 1;
  while (find(kPrefix + std::to_string(number)) != nullptr)
    ++number;
  Line line;
  line.entry.name = kPrefix + std::to_string(number);
  line.key = indent_ + line.entry.name + ": ";
  line.in_camera = true;
  setDevice(line, device);
  // Below the last camera, above the comments that follow it.
  const auto last = std::find_if(lines_.rbegin(), lines_.rend(),
                                 [](const Line& other) { return other.in_camera; });
  lines_.insert(last == lines_.rend() ? lines_.end() : last.base(), line);
  return line.entry.name;
}

std::string CameraList::text() const {
  std::string text;
  for (const Line& line : lines_)
    text += line.text + '\n';
  return text;
}

CameraList readCameraList(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf()))
    throw CameraListError(path + " cannot be read (" + std::strerror(errno) +
                          "): correct the path of the cameras.yaml");
  try {
    return CameraList(text.str());
  } catch (const CameraListError& e) {
    throw CameraListError(path + ", " + e.what());
  }
}

void writeCameraList(const CameraList& list, const std::string& path) {
  namespace fs = std::filesystem;
  // Through a symbolic link the file it names is replaced, not the link.
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
