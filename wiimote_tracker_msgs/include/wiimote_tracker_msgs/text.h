#pragma once

#include <boost/locale/utf.hpp>

#include <algorithm>
#include <cctype>
#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <ctime>
#include <iterator>
#include <limits>
#include <locale>
#include <sstream>
#include <string>
#include <vector>

// Text for people: messages of errors, log lines, tables.

namespace wiimote_tracker {

/// What std::printf would print: format("%.1f mm", 1e3 * metres).
[[gnu::format(printf, 1, 2)]] inline std::string format(const char* pattern, ...) {
  std::va_list values;
  va_start(values, pattern);
  std::va_list again;
  va_copy(again, values);
  std::string text(static_cast<std::size_t>(std::vsnprintf(nullptr, 0, pattern, values)), '\0');
  va_end(values);
  std::vsnprintf(text.data(), text.size() + 1, pattern, again);
  va_end(again);
  return text;
}

/// The shortest decimal number that reads back as the same finite double, with a point in every
/// locale.
inline std::string exactNumber(double value) {
  std::string text;
  for (int digits = std::numeric_limits<double>::digits10;
       digits <= std::numeric_limits<double>::max_digits10; ++digits) {
    std::stringstream stream;
    stream.imbue(std::locale::classic());
    stream.precision(digits);
    stream << value;
    text = stream.str();
    double back = 0.0;
    if (stream >> back && back == value)
      break;
  }
  return text;
}

/// Each of several numbers. @param values a std::vector, a std::array or Eigen's
template <typename Values>
std::vector<std::string> exactNumbers(const Values& values) {
  std::vector<std::string> numbers;
  std::transform(values.data(), values.data() + values.size(), std::back_inserter(numbers),
                 exactNumber);
  return numbers;
}

/// The date of a time since 1970 [s], in UTC. @param pattern of std::strftime
inline std::string utcDate(double time, const char* pattern = "%Y-%m-%d %H:%M:%S UTC") {
  const auto seconds = static_cast<std::time_t>(time);
  std::tm date{};
  char text[64];
  if (!gmtime_r(&seconds, &date) || std::strftime(text, sizeof text, pattern, &date) == 0)
    return "";
  return text;
}

/// ASCII letters in lower case.
inline std::string lowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// The text with U+FFFD in place of each byte that is not part of well-formed UTF-8 (RFC 3629).
inline std::string validUtf8(const std::string& text) {
  std::string valid;
  for (auto at = text.begin(); at != text.end();) {
    const auto start = at;
    const auto character = boost::locale::utf::utf_traits<char>::decode(at, text.end());
    if (boost::locale::utf::is_valid_codepoint(character)) {
      valid.append(start, at);
    } else {
      valid += "\xEF\xBF\xBD";
      at = start + 1;
    }
  }
  return valid;
}

/// Whether a text is a letter, then letters, digits and underscores, all of ASCII.
inline bool isWord(const std::string& text) {
  const auto isLetter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  return !text.empty() && isLetter(text[0]) && std::all_of(text.begin(), text.end(), [&](char c) {
    return isLetter(c) || (c >= '0' && c <= '9') || c == '_';
  });
}

/// "1 LED", "2 LEDs".
inline std::string counted(std::size_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

/// The words of a list as "a, b, c".
template <typename Words>
std::string joined(const Words& words, const char* separator = ", ") {
  std::string text;
  for (const std::string& word : words)
    text += (text.empty() ? "" : separator) + word;
  return text;
}

}  // namespace wiimote_tracker
