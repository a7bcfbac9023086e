#include "wiimote_tracker_triangulation/geometry/yaml_map.h"

#include "wiimote_tracker_triangulation/geometry/atomic_file.h"

#include <algorithm>

namespace wiimote_tracker::geometry {
namespace {

std::string pathOf(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "/" + key;
}

}  // namespace

YamlMap YamlMap::load(const std::string& file, const char* advice) {
  return parse(readFile(file), file, advice);
}

YamlMap YamlMap::parse(const std::string& text, const std::string& file, const char* advice) {
  if (text.find(kUnreadableText) != std::string::npos)
    throw FileError(file + " is damaged: it has '" + kUnreadableText + "'; " + advice);
  try {
    // With a line's end, since yaml-cpp 0.6 fills the memory also at a ":" that ends the text.
    return YamlMap(YAML::Load(text + '\n'), "", std::make_shared<File>(File{file, advice, {}, {}}));
  } catch (const YAML::Exception& e) {
    throw FileError(file + " is not YAML (" + e.what() + "); " + advice);
  }
}

YamlMap::YamlMap(const YAML::Node& node, const std::string& path, const std::shared_ptr<File>& file)
    : node_(node), path_(path), file_(file) {
  if (!node_.IsMap())
    throw FileError(file_->name + (path_.empty() ? "" : ": " + path_) +
                    " is not a map of keys and values; " + file_->advice);
  std::set<std::string> keys;
  for (const auto& entry : node_) {
    if (!entry.first.IsScalar())
      throw FileError(file_->name + ": " + path_ + " has a key that is not a string; " +
                      file_->advice);
    if (!keys.insert(entry.first.Scalar()).second)
      throw error(entry.first.Scalar(), "is there twice");
  }
  if (!file_->maps.insert(path_).second)
    return;
  for (const std::string& key : keys)
    file_->unread.emplace(path_, key);
}

void YamlMap::checkFormat(const std::string& format, int version) {
  if (get<std::string>("format") != format)
    throw error("format", "is not " + format);
  const auto found = get<std::string>("version");
  if (found != std::to_string(version))
    throw FileError(file_->name + ": version is " + found + ", but only " +
                    std::to_string(version) + " is understood; update this program");
}

std::vector<double> YamlMap::numbers(const std::string& key, std::size_t count) {
  const std::vector<double> result = numbers(key);
  if (result.size() != count)
    throw error(key, "is not a list of " + std::to_string(count) + " numbers");
  return result;
}

std::vector<std::vector<double>> YamlMap::rows(const std::string& key,
                                               std::size_t columns,
                                               const std::string& names) {
  const auto result = get<std::vector<std::vector<double>>>(key);
  if (std::any_of(result.begin(), result.end(),
                  [columns](const std::vector<double>& row) { return row.size() != columns; }))
    throw error(key, "has a row that is not [" + names + "]");
  return result;
}

Eigen::Vector3d YamlMap::vector(const std::string& key) {
  const std::vector<double> values = numbers(key);
  if (values.size() != 3)
    throw error(key, "must have three numbers: x, y, z");
  const Eigen::Vector3d vector(values[0], values[1], values[2]);
  if (!vector.allFinite())
    throw error(key, "must be finite");
  return vector;
}

YamlMap YamlMap::map(const std::string& key) {
  return YamlMap(value(key), pathOf(path_, key), file_);
}

std::vector<YamlMap> YamlMap::maps(const std::string& key) {
  const YAML::Node list = value(key);
  if (!list.IsSequence())
    throw error(key, "is not a list");
  std::vector<YamlMap> result;
  for (std::size_t i = 0; i < list.size(); ++i)
    result.push_back(YamlMap(list[i], pathOf(path_, key) + "[" + std::to_string(i) + "]", file_));
  return result;
}

std::vector<std::pair<std::string, YamlMap>> YamlMap::entries() {
  std::vector<std::pair<std::string, YamlMap>> result;
  for (const auto& entry : node_)
    result.emplace_back(entry.first.Scalar(), map(entry.first.Scalar()));
  return result;
}

void YamlMap::refuseUnknown() const {
  if (file_->unread.empty())
    return;
  const auto& [path, key] = *file_->unread.begin();
  throw FileError(file_->name + ": " + pathOf(path, key) +
                  " is an unknown key, perhaps of a later version; " + file_->advice);
}

FileError YamlMap::error(const std::string& key, const std::string& is_wrong) const {
  return FileError(file_->name + ": " + pathOf(path_, key) + " " + is_wrong + "; " + file_->advice);
}

YAML::Node YamlMap::value(const std::string& key) {
  file_->unread.erase({path_, key});
  const YAML::Node found = node_[key];
  if (!found.IsDefined())
    throw error(key, "is missing");
  return found;
}

}  // namespace wiimote_tracker::geometry
