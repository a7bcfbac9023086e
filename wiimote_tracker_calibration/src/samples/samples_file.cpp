#include "samples/samples_file.h"

#include "samples_yaml.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/atomic_file.h>
#include <wiimote_tracker_triangulation/geometry/error.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <locale>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::samples {

namespace {

// Ten minutes of 64 cameras, of which each number has 17 digits [bytes].
constexpr std::size_t kLargestFile = 300000000;
// Between the two YAML documents of the file.
constexpr const char* kFramesLine =
    "--- # Images of the wave, camera by camera: time [s], then x and y [px] of every spot.";
// Before the frames of each camera.
constexpr const char* kCameraLine = "- |";
// The last line: a file that was cut off lacks it.
constexpr const char* kEndLine = "...";
// Before each image.
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

/// Appends one line per image, indented: stamp [s], then x and y [px] of every spot.
void appendFrames(const std::vector<wave::Frame>& frames, std::string* text) {
  for (const wave::Frame& frame : frames) {
    *text += kIndent;
    *text += exactNumber(frame.stamp);
    for (const Eigen::Vector2d& spot : frame.spots)
      *text += " " + exactNumber(spot.x()) + " " + exactNumber(spot.y());
    *text += '\n';
  }
}

/// Reads a text line by line.
class Lines {
 public:
  /// @param text outlives this; @param begin where to start in it; @param where names the file.
  Lines(const std::string& text, std::size_t begin, const std::string& where)
      : text_(text),
        position_(begin),
        where_(where),
        number_(static_cast<std::size_t>(
            std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(begin), '\n'))) {}

  /// @throws Error naming the line: the next line is different.
  void expect(const std::string& line) {
    if (next() != line)
      refuse("is not '" + line + "'");
  }

  /// Reads what appendFrames() wrote.
  /// @throws Error naming the line: the next `count` lines are not frames.
  std::vector<wave::Frame> frames(std::size_t count) {
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

  /// @throws Error: there are more lines.
  void expectEnd() const {
    if (position_ != text_.size())
      refuse("is not the last");
  }

 private:
  std::string next() {
    ++number_;
    const std::size_t end = text_.find('\n', position_);
    if (end == std::string::npos)
      refuse("is cut off");
    std::string line = text_.substr(position_, end - position_);
    position_ = end + 1;
    return line;
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw Error(where_ + ": line " + std::to_string(number_) + " " + what +
                "; restore the file from its backup or capture again");
  }

  const std::string& text_;
  std::size_t position_;
  std::string where_;
  std::size_t number_;  // of the line read last, as an editor counts
};

void require(bool condition, const std::string& what) {
  if (!condition)
    throw Error(what + "; correct it or capture again");
}

void checkCamera(const wave::CameraRecording& camera) {
  const square::CameraSightings& sightings = camera.sightings;
  const std::string& name = sightings.name;
  sightings.intrinsics.check();
  for (const auto& corner : sightings.corners)
    require(!corner || corner->allFinite(), "a corner that " + name + " saw is not finite");
  for (const auto& place : sightings.places)
    require(!place || place->allFinite(), "a place that " + name + " saw is not finite");
  require(!sightings.gravity || sightings.gravity->allFinite(),
          "the gravity of " + name + " is not finite");
  for (const geometry::ImageMask& mask : camera.masks)
    require(mask.center.allFinite() && std::isfinite(mask.radius) && mask.radius > 0.0,
            "a mask of " + name + " is not finite or its radius not above 0");
  double before = -std::numeric_limits<double>::infinity();
  for (const wave::Frame& frame : camera.frames) {
    require(std::isfinite(frame.stamp), "the time of an image of " + name + " is not finite");
    require(frame.stamp > before, "the images of " + name + " are not in the order of their times");
    before = frame.stamp;
    for (const Eigen::Vector2d& spot : frame.spots)
      require(spot.allFinite(), "a spot of " + name + " is not finite");
  }
}

/// Checks what readSamplesFile() requires.
void check(const Samples& samples) {
  const wave::Recording& recording = samples.recording;
  require(!samples.world_frame.empty(), "the world frame has no name");
  if (recording.square)
    recording.square->check();
  if (recording.wand)
    recording.wand->check();
  std::set<std::string> names;
  for (const wave::CameraRecording& camera : recording.cameras) {
    const std::string& name = camera.sightings.name;
    require(!name.empty(), "a camera has no name");
    require(names.insert(name).second, "two cameras are called " + name);
    checkCamera(camera);
    const auto& corners = camera.sightings.corners;
    require(recording.square || std::none_of(corners.begin(), corners.end(),
                                             [](const auto& corner) { return corner.has_value(); }),
            "there is no square, but " + name + " saw a corner of it");
    require(
        camera.sightings.places.size() == (recording.square ? recording.square->places.size() : 0),
        "the known places are not as many as " + name + " has pixels for");
  }
}

}  // namespace

void writeSamplesFile(const Samples& samples, const std::string& path) {
  check(samples);
  std::string text = yamlFromSamples(samples);
  text += std::string("\n") + kFramesLine + "\n";
  for (const wave::CameraRecording& camera : samples.recording.cameras) {
    text += std::string(kCameraLine) + "\n";
    appendFrames(camera.frames, &text);
  }
  text += std::string(kEndLine) + "\n";
  if (text.size() > kLargestFile)
    throw Error(format(
        "what was captured fills %.0f MB, but a samples file has %.0f MB at most: record the "
        "wave again, for a shorter time",
        1e-6 * static_cast<double>(text.size()), 1e-6 * static_cast<double>(kLargestFile)));
  geometry::writeFileAtomically(path, text);
}

Samples readSamplesFile(const std::string& path) {
  const std::string text = geometry::readFile(path, kLargestFile);
  const std::size_t head_end = text.find(std::string("\n") + kFramesLine + "\n");
  if (head_end == std::string::npos)
    throw Error(path +
                " is cut off, or holds no samples of a calibration; restore it from its "
                "backup, or choose a file that save_samples wrote");
  SamplesHead head = headFromYaml(text.substr(0, head_end + 1), path);
  Lines lines(text, head_end + 1, path);
  lines.expect(kFramesLine);
  for (std::size_t i = 0; i < head.frames.size(); ++i) {
    lines.expect(kCameraLine);
    head.samples.recording.cameras[i].frames = lines.frames(head.frames[i]);
  }
  lines.expect(kEndLine);
  lines.expectEnd();
  try {
    check(head.samples);
  } catch (const geometry::Error& error) {
    throw Error(path + ": " + error.what());
  }
  return head.samples;
}

}  // namespace wiimote_tracker::samples
