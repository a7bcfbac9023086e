#include "documented_parameters.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <vector>

namespace wiimote_tracker {
namespace {

struct Entry {
  std::string value;  // as YAML
  std::string comment;
};

/// The entries of a YAML file by their keys, such as "tracks/gate".
std::map<std::string, Entry> readEntries(const std::string& path) {
  static const std::regex key_line("( *)(\\w+):(.*)");
  static const std::regex comment_line(" *# ?(.*)");
  std::map<std::string, Entry> entries;
  std::vector<std::string> groups;
  std::string comment;
  bool goes_on = false;  // the line above is a comment
  std::ifstream file(path);
  EXPECT_TRUE(file) << path;
  for (std::string line; std::getline(file, line);) {
    std::smatch match;
    const bool is_comment = std::regex_match(line, match, comment_line);
    if (is_comment) {
      comment = (goes_on ? comment + " " : "") + match[1].str();
    } else if (std::regex_match(line, match, key_line)) {
      groups.resize(static_cast<std::size_t>(match[1].length()) / 2);
      std::string key;
      for (const std::string& group : groups)
        key += group + "/";
      if (match[3].length() == 0)
        groups.push_back(match[2]);
      else
        entries[key + match[2].str()] = {match[3], comment};
    } else {
      EXPECT_TRUE(line.empty()) << line;
      comment.clear();
    }
    goes_on = is_comment;
  }
  return entries;
}

bool isSame(const YAML::Node& value, const std::string& expected) {
  if (value.IsSequence()) {
    const YAML::Node list = YAML::Load(expected);
    bool is_same = list.IsSequence() && list.size() == value.size();
    for (std::size_t i = 0; is_same && i < value.size(); ++i)
      is_same = isSame(value[i], list[i].Scalar());
    return is_same;
  }
  double a = 0.0, b = 0.0;
  std::istringstream text(expected);
  if (YAML::convert<double>::decode(value, a) && text >> b && text.eof())
    return a == b;
  return value.Scalar() == expected;
}

/// Whether a word is this number, or the name of a parameter in the same group with this value.
bool isBound(const std::string& word,
             double number,
             const std::string& group,
             const std::map<std::string, Entry>& entries) {
  const auto other = entries.find(group + word);
  std::istringstream text(other != entries.end() ? other->second.value : word);
  double value = 0.0;
  return text >> value && value == number;
}

}  // namespace

void expectDocumented(const ParameterReader& reader, const std::string& path) {
  static const std::regex range_text("([\\w.]+) to ([\\w.]*\\w)");
  static const std::regex unit("\\[[^\\]]+\\]");
  const std::map<std::string, Entry> entries = readEntries(path);
  for (const auto& [key, entry] : entries)
    EXPECT_EQ(1u, reader.defaults().count(key)) << key << " in " << path << " is no parameter";
  for (const auto& [key, expected] : reader.defaults()) {
    const auto found = entries.find(key);
    if (found == entries.end()) {
      ADD_FAILURE() << key << " is not in " << path;
      continue;
    }
    const Entry& entry = found->second;
    EXPECT_TRUE(isSame(YAML::Load(entry.value), expected)) << key << " is " << expected;
    EXPECT_FALSE(entry.comment.empty()) << key << " has no comment";
    const auto range = reader.ranges().find(key);
    if (range == reader.ranges().end())
      continue;
    EXPECT_TRUE(std::regex_search(entry.comment, unit)) << key << " has no unit";
    const std::string group = key.substr(0, key.rfind('/') + 1);
    bool is_found = false;
    const std::string& comment = entry.comment;
    for (std::sregex_iterator match(comment.begin(), comment.end(), range_text), end; match != end;
         ++match) {
      is_found = is_found || (isBound((*match)[1], range->second.first, group, entries) &&
                              isBound((*match)[2], range->second.second, group, entries));
    }
    EXPECT_TRUE(is_found) << key << " goes from " << range->second.first << " to "
                          << range->second.second << ", but its comment is: " << comment;
  }
}

}  // namespace wiimote_tracker
