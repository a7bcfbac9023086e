#include "yaml_line.h"

#include <algorithm>
#include <cctype>

namespace wiimote_tracker::list_wiimotes {
namespace {

constexpr char kBlanks[] = " \t\r";

bool isWordCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

}  // namespace

bool isBlankOrComment(const std::string& text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  return first == std::string::npos || text[first] == '#';
}

std::optional<Assignment> parseAssignment(const std::string& line) {
  const std::size_t key = line.find_first_not_of(kBlanks);
  const std::size_t colon = line.find(':', key);
  if (key == std::string::npos || colon == std::string::npos || colon == key)
    return std::nullopt;
  Assignment assignment;
  assignment.key = line.substr(key, colon - key);
  if (!std::all_of(assignment.key.begin(), assignment.key.end(), isWordCharacter))
    return std::nullopt;
  std::size_t value = line.find_first_not_of(kBlanks, colon + 1);
  if (value == std::string::npos)
    return assignment;
  if (value == colon + 1)
    return std::nullopt;
  if (line[value] == '#')
    return assignment;

  std::size_t end;  // of the value with its quotes
  const char quote = line[value];
  if (quote == '"' || quote == '\'') {
    const std::size_t closing = line.find(quote, value + 1);
    if (closing == std::string::npos)
      return std::nullopt;
    assignment.value = line.substr(value + 1, closing - value - 1);
    end = closing + 1;
  } else {
    // What begins so is no plain text to YAML.
    if (std::string("{}[]&*!|>%@`,").find(quote) != std::string::npos)
      return std::nullopt;
    end = std::min(line.find_first_of(kBlanks, value), line.size());
    assignment.value = line.substr(value, end - value);
  }
  assignment.before = line.substr(0, value);
  assignment.after = line.substr(end);
  const bool closed = assignment.after.empty() || assignment.after[0] != '#';
  if (assignment.value.empty() || !closed || !isBlankOrComment(assignment.after))
    return std::nullopt;
  return assignment;
}

}  // namespace wiimote_tracker::list_wiimotes
