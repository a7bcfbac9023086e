#include "frame_lines.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <locale>
#include <sstream>

namespace wiimote_tracker::session {

namespace {

constexpr const char* kIndent = "  ";

/// The finite numbers of a line, separated by single spaces; empty when it is anything else.
std::vector<double> numbersOf(const std::string& line) {
  std::istringstream stream(line);
  stream.imbue(std::locale::classic());
  stream >> std::noskipws;
  std::vector<double> numbers;
  for (double number = 0.0; stream >> number;) {
    numbers.push_back(number);
    if (stream.eof())
      return numbers;
    if (stream.get() != ' ')
      return {};
  }
  return {};
}

}  // namespace

void appendFrames(const std::vector<wave::Frame>& frames, std::string* text) {
  for (const wave::Frame& frame : frames) {
    *text += kIndent;
    *text += exactNumber(frame.stamp);
    for (const Eigen::Vector2d& spot : frame.spots)
      *text += " " + exactNumber(spot.x()) + " " + exactNumber(spot.y());
    *text += '\n';
  }
}

Lines::Lines(const std::string& text, std::size_t begin, const std::string& where)
    : text_(text),
      position_(begin),
      where_(where),
      number_(static_cast<std::size_t>(
          std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(begin), '\n'))) {}

void Lines::expect(const std::string& line) {
  if (next() != line)
    refuse("is not '" + line + "'");
}

std::vector<wave::Frame> Lines::frames(std::size_t count) {
  std::vector<wave::Frame> frames;
  const std::string indent = kIndent;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string line = next();
    if (line.compare(0, indent.size(), indent) != 0)
      refuse("is not an image");
    const std::vector<double> numbers = numbersOf(line.substr(indent.size()));
    if (numbers.size() % 2 != 1)
      refuse("is not the time of an image and the places of its spots");
    wave::Frame frame;
    frame.stamp = numbers[0];
    for (std::size_t n = 1; n < numbers.size(); n += 2)
      frame.spots.emplace_back(numbers[n], numbers[n + 1]);
    frames.push_back(std::move(frame));
  }
  return frames;
}

void Lines::expectEnd() {
  if (position_ != text_.size())
    refuse("is not the last");
}

std::string Lines::next() {
  ++number_;
  const std::size_t end = text_.find('\n', position_);
  if (end == std::string::npos)
    refuse("is cut off");
  std::string line = text_.substr(position_, end - position_);
  position_ = end + 1;
  return line;
}

void Lines::refuse(const std::string& what) const {
  throw Error(where_ + ": line " + std::to_string(number_) + " " + what +
              "; restore the file from its backup or capture again");
}

}  // namespace wiimote_tracker::session
