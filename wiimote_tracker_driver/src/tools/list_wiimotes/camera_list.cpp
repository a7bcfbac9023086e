#include "camera_list.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

namespace wiimote_tracker::list_wiimotes {
namespace {

constexpr char kPrefix[] = "wiimote_";

std::string lowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool isBlankOrComment(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  return first == std::string::npos || line[first] == '#';
}

}  // namespace

CameraList::CameraList()
    : CameraList(
          "# The Wii Remotes of a rig: name of the camera (its namespace and the prefix of its "
          "frames) and the\n# Bluetooth address.\ncameras:\n") {}

CameraList::CameraList(const std::string& text) {
  static const std::regex header(R"(cameras:\s*(#.*)?)");
  static const std::regex camera(
      R"re(([ \t]+)([A-Za-z]\w*):[ \t]+(?:"([^"]+)"|'([^']+)'|([^\s"'#{\[&*!|>][^\s#]*))(\s*|\s+#.*))re");
  bool in_cameras = false;
  std::istringstream stream(text);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    Line parsed;
    parsed.text = line;
    std::smatch match;
    if (isBlankOrComment(line)) {
      // stays as it is
    } else if (!in_cameras && std::regex_match(line, header)) {
      in_cameras = true;
    } else if (in_cameras && std::regex_match(line, match, camera)) {
      parsed.indent = match[1];
      parsed.entry.name = match[2];
      parsed.entry.device = match[3].str() + match[4].str() + match[5].str();
      parsed.comment = match[6];
      if (find(parsed.entry.name) != nullptr)
        throw CameraListError("line " + std::to_string(number) + ": camera " + parsed.entry.name +
                              " is there twice: remove one of the lines");
    } else {
      throw CameraListError("line " + std::to_string(number) + " is '" + line +
                            "': write \"cameras:\" and below it one line  name: \"address\"  for "
                            "each camera, indented alike");
    }
    lines_.push_back(parsed);
  }
  if (!in_cameras)
    throw CameraListError("there is no line \"cameras:\": write one above the cameras");
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
  line->entry.device = device;
  line->text = line->indent + name + ": \"" + device + '"' + line->comment;
}

std::string CameraList::add(const std::string& device) {
  int number = 1;
  while (find(kPrefix + std::to_string(number)) != nullptr)
    ++number;
  Line line;
  line.entry = {kPrefix + std::to_string(number), device};
  line.indent = "  ";
  // Below the last camera; its indentation is theirs.
  auto where = lines_.end();
  for (auto i = lines_.begin(); i != lines_.end(); ++i) {
    if (!i->entry.name.empty()) {
      line.indent = i->indent;
      where = i + 1;
    }
  }
  line.text = line.indent + line.entry.name + ": \"" + device + '"';
  lines_.insert(where, line);
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
