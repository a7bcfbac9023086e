// The layout follows the C3D File Format User Guide: a header block, blocks of parameters, and
// blocks of points, each of 512 bytes; numbers of 16 and 32 bits, least byte first.
#include "ros/measurements/sample_table.h"
#include "ros/measurements/writer.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace wiimote_tracker::measurements {
namespace {

constexpr std::size_t kBlock = 512;  // [bytes]
constexpr std::size_t kLabelsInParameter = 255;
constexpr std::size_t kLongestLabel = 64;
constexpr std::size_t kMostFrames = 65535;  // in 16 bits; more are in LONG_FRAMES and TRIAL
constexpr char kParameterBlock = 2;         // number of the first block of parameters
constexpr char kIntel = 84;
constexpr double kMillimetres = 1000.0;

std::string integer(std::size_t value) {
  return {static_cast<char>(value & 0xff), static_cast<char>(value >> 8 & 0xff)};
}

std::string real(double value) {
  static_assert(sizeof(float) == 4, "C3D has IEEE numbers of four bytes");
  const float number = static_cast<float>(value);
  std::uint32_t bits = 0;
  std::memcpy(&bits, &number, sizeof bits);
  return integer(bits & 0xffff) + integer(bits >> 16);
}

std::string padded(std::string text, std::size_t size) {
  text.resize(size, ' ');
  return text;
}

std::string inBlocks(std::string bytes) {
  bytes.resize((bytes.size() + kBlock - 1) / kBlock * kBlock, '\0');
  return bytes;
}

/// The section of parameters. A group's number is that of its groups so far.
class Parameters {
 public:
  void group(const std::string& name) {
    ++groups_;
    append(static_cast<char>(-groups_), name, "", "");
  }

  /// Numbers of 16 bits.
  void integers(const std::string& name, const std::vector<std::size_t>& values) {
    std::string data;
    for (const std::size_t value : values)
      data += integer(value);
    add(name, 2, values.size() == 1 ? std::vector<std::size_t>() : std::vector{values.size()},
        data);
  }

  void number(const std::string& name, double value) { add(name, 4, {}, real(value)); }

  void texts(const std::string& name,
             const std::vector<std::string>& values,
             const std::string& description = "") {
    std::size_t longest = 1;
    for (const std::string& value : values)
      longest = std::max(longest, std::min(value.size(), kLongestLabel));
    std::string data;
    for (const std::string& value : values)
      data += padded(value, longest);
    add(name, -1, {longest, values.size()}, data, description);
  }

  std::string bytes() const {
    // The last offset is 0.
    std::string all = records_;
    all.replace(last_offset_, 2, integer(0));
    const std::size_t blocks = inBlocks(std::string(4, '\0') + all).size() / kBlock;
    return inBlocks(std::string{1, 'P', static_cast<char>(blocks), kIntel} + all);
  }

 private:
  void add(const std::string& name,
           int type,
           const std::vector<std::size_t>& size,
           const std::string& data,
           const std::string& description = "") {
    std::string content{static_cast<char>(type), static_cast<char>(size.size())};
    for (const std::size_t length : size)
      content += static_cast<char>(length);
    append(static_cast<char>(groups_), name, content + data, description);
  }

  void append(char group,
              const std::string& name,
              const std::string& content,
              const std::string& description) {
    records_ += static_cast<char>(name.size());
    records_ += group + name;
    last_offset_ = records_.size();
    records_ += integer(2 + content.size() + 1 + description.size()) + content;
    records_ += static_cast<char>(description.size());
    records_ += description;
  }

  int groups_ = 0;
  std::string records_;
  std::size_t last_offset_ = 0;
};

std::string parametersOf(const Samples& samples, std::size_t data_block) {
  const std::size_t frames = samples.frames;
  Parameters parameters;
  parameters.group("POINT");
  parameters.integers("USED", {samples.labels.size()});
  parameters.number("SCALE", -1.0);  // negative: points are floating-point numbers
  parameters.number("RATE", samples.rate);
  parameters.integers("DATA_START", {data_block});
  parameters.integers("FRAMES", {std::min(frames, kMostFrames)});
  parameters.number("LONG_FRAMES", static_cast<double>(frames));
  parameters.texts("UNITS", {"mm"});
  parameters.texts("X_SCREEN", {"+X"});
  parameters.texts("Y_SCREEN", {"+Z"});
  for (std::size_t first = 0; first < samples.labels.size() || first == 0;
       first += kLabelsInParameter) {
    const auto begin = samples.labels.begin() + first;
    const auto count = std::min(kLabelsInParameter, samples.labels.size() - first);
    const std::vector<std::string> labels(begin, begin + count);
    const std::string number = first == 0 ? "" : std::to_string(first / kLabelsInParameter + 1);
    parameters.texts("LABELS" + number, labels);
    parameters.texts("DESCRIPTIONS" + number, std::vector<std::string>(count));
  }
  parameters.group("ANALOG");
  parameters.integers("USED", {0});
  parameters.number("RATE", samples.rate);
  parameters.number("GEN_SCALE", 1.0);
  parameters.group("TRIAL");
  parameters.integers("ACTUAL_START_FIELD", {1, 0});
  parameters.integers("ACTUAL_END_FIELD", {frames & 0xffff, frames >> 16});
  if (frames > 0) {  // no group of the guide has an absolute time
    parameters.group("WIIMOTE_TRACKER");
    parameters.texts("START_TIME", {secondsOf(samples.start)},
                     "Time of frame 1 [s since 1970-01-01, UTC]");
  }
  return parameters.bytes();
}

std::string headerOf(const Samples& samples, std::size_t data_block) {
  const std::string none = integer(0);
  return inBlocks(std::string{kParameterBlock, 'P'} + integer(samples.labels.size()) + none +
                  integer(1) + integer(std::min(samples.frames, kMostFrames)) + none + real(-1.0) +
                  integer(data_block) + none + real(samples.rate));
}

/// x, y, z, and what says whether the point is valid: -1 no, 0 interpolated.
std::string pointsOf(const Samples& samples, std::size_t frame) {
  std::string bytes;
  for (const auto& positions : samples.positions) {
    const Eigen::Vector3d& position = positions[frame];
    const bool is_valid = position.allFinite();
    for (int axis = 0; axis < 3; ++axis)
      bytes += real(is_valid ? kMillimetres * position[axis] : 0.0);
    bytes += real(is_valid ? 0.0 : -1.0);
  }
  return bytes;
}

void writeC3d(const Samples& samples, OutputFile* file) {
  const std::size_t data_block = kParameterBlock + parametersOf(samples, 0).size() / kBlock;
  file->write(headerOf(samples, data_block) + parametersOf(samples, data_block));
  std::size_t size = 0;
  for (std::size_t frame = 0; frame < samples.frames; ++frame) {
    const std::string points = pointsOf(samples, frame);
    file->write(points);
    size += points.size();
  }
  file->write(std::string((kBlock - size % kBlock) % kBlock, '\0'));
}

}  // namespace

std::unique_ptr<Writer> makeC3dWriter(const std::string& path, double rate) {
  return std::make_unique<SampledWriter>(path, rate, writeC3d);
}

}  // namespace wiimote_tracker::measurements
