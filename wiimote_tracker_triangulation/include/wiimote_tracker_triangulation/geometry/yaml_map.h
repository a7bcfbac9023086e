#pragma once

#include <wiimote_tracker_msgs/error.h>

#include <yaml-cpp/yaml.h>
#include <Eigen/Core>

#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace wiimote_tracker::geometry {

/// Files with this are refused: yaml-cpp 0.6 fills the memory there, even inside quotes.
constexpr const char* kUnreadableText = ":]";

/// A map of a YAML file that is read strictly: a key that is missing, of the wrong type, out of
/// range, there twice, or never asked for is a FileError that names the file and the key in full,
/// such as "rig.yaml: cameras/left/image_width". All functions throw it.
class YamlMap {
 public:
  /// The whole of a file. `advice`: what the user should do about errors; outlives the map.
  static YamlMap load(const std::string& file, const char* advice);

  /// The same of the file's text.
  static YamlMap parse(const std::string& text, const std::string& file, const char* advice);

  /// Reads the keys "format" and "version", which must be these.
  void checkFormat(const std::string& format, int version);

  /// Whether an optional key is there.
  bool has(const std::string& key) const { return node_[key].IsDefined(); }

  template <typename T>
  T get(const std::string& key) {
    const YAML::Node found = value(key);
    if (std::is_same_v<T, std::string> && found.IsNull())  // it would be "null"
      throw error(key, "has no value");
    try {
      return found.template as<T>();
    } catch (const YAML::Exception&) {
      throw error(key, "has the wrong type");
    }
  }

  template <typename T>
  T get(const std::string& key, const T& default_value) {
    return has(key) ? get<T>(key) : default_value;
  }

  /// A number within [minimum, maximum]; a whole one when T is an integer.
  template <typename T>
  T bounded(const std::string& key, T minimum, T maximum) {
    using Wide = std::conditional_t<std::is_integral_v<T>, long long, double>;
    const auto number = get<Wide>(key);
    if (static_cast<Wide>(minimum) <= number && number <= static_cast<Wide>(maximum))
      return static_cast<T>(number);  // never NaN
    std::ostringstream text;
    text << "is " << number << ", but must be within " << minimum << " and " << maximum;
    throw error(key, text.str());
  }

  template <typename T>
  T bounded(const std::string& key, T minimum, T maximum, T default_value) {
    return has(key) ? bounded(key, minimum, maximum) : default_value;
  }

  std::vector<double> numbers(const std::string& key) { return get<std::vector<double>>(key); }

  /// A list of `count` numbers.
  std::vector<double> numbers(const std::string& key, std::size_t count);

  /// A list of lists of `columns` numbers each. `names`: of the columns, for the error.
  std::vector<std::vector<double>> rows(const std::string& key,
                                        std::size_t columns,
                                        const std::string& names);

  /// Three finite numbers.
  Eigen::Vector3d vector(const std::string& key);

  YamlMap map(const std::string& key);

  /// A list of maps.
  std::vector<YamlMap> maps(const std::string& key);

  /// All keys of this map, with their values, which must be maps; in the order of the file.
  std::vector<std::pair<std::string, YamlMap>> entries();

  /// Throws for a key that was never read, of any map of the file that was read.
  void refuseUnknown() const;

  /// The error that a key `is wrong`, to be thrown.
  FileError error(const std::string& key, const std::string& is_wrong) const;

 private:
  struct File {
    std::string name;
    const char* advice;
    std::set<std::string> maps;                            // paths of the maps that were read
    std::set<std::pair<std::string, std::string>> unread;  // path of such a map, and a key
  };

  YamlMap(const YAML::Node& node, const std::string& path, const std::shared_ptr<File>& file);

  YAML::Node value(const std::string& key);

  // Const: the other operator[] of a node would insert the key.
  const YAML::Node node_;
  std::string path_;  // of this map in the file
  std::shared_ptr<File> file_;
};

}  // namespace wiimote_tracker::geometry
