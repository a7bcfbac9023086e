#include "documented_parameters.h"

#include <gtest/gtest.h>
#include <wiimote_tracker_msgs/text.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <cstddef>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker {
namespace {

/// By keys such as "tracks/gate".
using Values = std::map<std::string, YAML::Node>;
using Comments = std::map<std::string, std::string>;

void addValues(const YAML::Node& node, const std::string& key, Values* values) {
  if (!node.IsMap()) {
    EXPECT_TRUE(values->emplace(key, node).second) << key << " is there twice";
    return;
  }
  for (const auto& member : node)
    addValues(member.second, (key.empty() ? "" : key + "/") + member.first.as<std::string>(),
              values);
}

/// The comment directly above each key; empty if there is none.
Comments readComments(const std::string& path) {
  static const std::regex key_line("( *)(\\w+):.*");
  static const std::regex comment_line(" *# ?(.*)");
  Comments comments;
  std::vector<std::string> levels;  // of the last key
  std::string comment;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::smatch match;
    if (std::regex_match(line, match, comment_line)) {
      comment += (comment.empty() ? "" : " ") + match[1].str();
      continue;
    }
    if (std::regex_match(line, match, key_line)) {
      levels.resize(static_cast<std::size_t>(match[1].length()) / 2);
      std::string group;
      for (const std::string& level : levels)
        group += level + "/";
      comments[group + match[2].str()] = comment;
      levels.push_back(match[2]);
    }
    comment.clear();
  }
  return comments;
}

std::optional<double> numberOf(const std::string& text) {
  std::istringstream stream(text);
  double number = 0.0;
  return stream >> number && stream.eof() ? std::make_optional(number) : std::nullopt;
}

bool isSame(const YAML::Node& value, const std::string& expected) {
  if (value.IsSequence()) {
    const YAML::Node list = YAML::Load(expected);
    bool is_same = list.IsSequence() && list.size() == value.size();
    for (std::size_t i = 0; is_same && i < value.size(); ++i)
      is_same = isSame(value[i], list[i].Scalar());
    return is_same;
  }
  double number = 0.0;
  const std::optional<double> wanted = numberOf(expected);
  if (wanted && YAML::convert<double>::decode(value, number))
    return number == *wanted;
  return value.Scalar() == expected;
}

/// `text`: a number, a multiple of pi, or the name of a parameter in the group ("" or "tracks/").
/// NaN if it is none of them.
double boundOf(const std::string& text, const std::string& group, const Values& values) {
  static const std::regex number("(-?[0-9]+(?:\\.[0-9]+)?(?:e[-+]?[0-9]+)?)( pi)?");
  const auto other = values.find(group + text);
  const std::string word = other != values.end() ? other->second.Scalar() : text;
  std::smatch match;
  if (!std::regex_match(word, match, number))
    return std::numeric_limits<double>::quiet_NaN();
  return std::stod(match[1]) * (match[2].matched ? M_PI : 1.0);
}

void expectRange(const std::pair<double, double>& range,
                 const std::string& key,
                 const std::string& comment,
                 const Values& values) {
  static const std::regex range_text("\\[[^\\],]+, ([^\\],]+)\\.\\.([^\\],]+)\\]");
  std::smatch match;
  if (!std::regex_search(comment, match, range_text)) {
    ADD_FAILURE() << key << " has no [unit, A..B] in its comment: " << comment;
    return;
  }
  const std::string group = key.substr(0, key.rfind('/') + 1);
  const bool is_range = boundOf(match[1], group, values) == range.first &&
                        boundOf(match[2], group, values) == range.second;
  EXPECT_TRUE(is_range) << key << " goes from " << range.first << " to " << range.second
                        << ", but its comment is: " << comment;
}

}  // namespace

void expectDocumented(const ParameterReader& reader, const std::string& path) {
  Values values;
  addValues(YAML::LoadFile(path), "", &values);
  Comments comments = readComments(path);
  EXPECT_FALSE(reader.defaults().empty()) << "no parameter was read";
  for (const auto& [key, value] : values)
    EXPECT_EQ(1u, reader.defaults().count(key)) << key << " in " << path << " is no parameter";
  for (const auto& [key, expected] : reader.defaults()) {
    const auto value = values.find(key);
    if (value == values.end()) {
      ADD_FAILURE() << key << " is not in " << path;
      continue;
    }
    EXPECT_TRUE(isSame(value->second, expected)) << key << " is " << expected;
    const std::string& comment = comments[key];
    if (comment.empty() || comment.back() != '.') {
      ADD_FAILURE() << key << " has no sentence directly above it: " << comment;
      continue;
    }
    const auto range = reader.ranges().find(key);
    if (range != reader.ranges().end())
      expectRange(range->second, key, comment, values);
    else
      EXPECT_FALSE(numberOf(expected)) << key << " is a number without a range in the code";
    const auto choice = reader.choices().find(key);
    if (choice != reader.choices().end()) {
      const std::string words = "[" + joined(choice->second) + "]";
      EXPECT_NE(std::string::npos, comment.find(words))
          << key << " has no " << words << " in its comment: " << comment;
    }
  }
}

}  // namespace wiimote_tracker
