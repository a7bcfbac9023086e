#include "recording/reader.h"

#include <wiimote_tracker_msgs/text.h>
#include <boost/endian/conversion.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <sstream>

namespace wiimote_tracker::recording {
namespace {

namespace endian = boost::endian;

// Greatest plausible times [s]; ROS time ends in 2106.
constexpr double kLatestWallTime = 3e9;
constexpr double kLongest = 1e9;

/// @returns the number of bytes read, at most `size`.
std::size_t readBytes(std::istream& in, void* to, std::size_t size) {
  in.read(static_cast<char*>(to), static_cast<std::streamsize>(size));
  return static_cast<std::size_t>(in.gcount());
}

bool isReport(Record::Kind kind) {
  return kind == Record::Kind::kReceived || kind == Record::Kind::kSent;
}

bool isKind(std::uint8_t kind) {
  return kind >= static_cast<std::uint8_t>(Record::Kind::kConnected) && kind <= kWaitedKind;
}

transport::Remote remoteOf(const std::string& text) {
  std::istringstream lines(text);
  transport::Remote remote;
  std::getline(lines, remote.identity);
  std::getline(lines, remote.kernel_driver);
  std::getline(lines, remote.description, '\0');
  return remote;
}

}  // namespace

std::ifstream openRecording(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    const std::string reason = std::strerror(errno);
    const std::filesystem::path given(path);
    const std::string advice = given.is_absolute() ? "correct its path"
                                                   : "it was looked for in " +
                                                         std::filesystem::current_path().string() +
                                                         "; give an absolute path";
    throw BadRecording("cannot read the recording (" + reason + "): " + advice);
  }
  // A folder can be opened and then reads like an empty file.
  if (std::filesystem::is_directory(path))
    throw BadRecording("cannot read the recording (it is a folder): correct its path");
  return file;
}

Reader::Reader(std::istream& in) : in_(in) {
  std::array<std::uint8_t, kFixedHeaderSize> fixed{};
  const std::size_t size = readBytes(in_, fixed.data(), fixed.size());
  if (!std::equal(fixed.begin(), fixed.begin() + std::min(size, kMagicSize), kMagic))
    throw BadRecording("this is not a recording of a Wii Remote: choose another file");
  if (size < fixed.size())
    throw BadRecording("the recording is cut off in its header: choose another file");
  const std::uint32_t version = endian::load_little_u32(&fixed[kMagicSize]);
  if (version != kVersion)
    throw BadRecording("the recording is of version " + std::to_string(version) +
                       " and this driver knows version " + std::to_string(kVersion) +
                       ": use the driver that made it");
  header_.wall_time = 1e-9 * static_cast<double>(endian::load_little_u64(&fixed[kMagicSize + 4]));
  if (header_.wall_time > kLatestWallTime)
    throw BadRecording("the recording is damaged in its header: choose another file");
  header_.software.resize(fixed.back());
  if (readBytes(in_, &header_.software[0], header_.software.size()) < header_.software.size())
    throw BadRecording("the recording is cut off in its header: choose another file");
  position_ = kFixedHeaderSize + header_.software.size();
  payload_.reserve(kLongestPayload);
}

bool Reader::end(const char* why) {
  damage_ = format("the recording %s at byte %llu, %.3f s after its start", why,
                   static_cast<unsigned long long>(position_), 1e-9 * static_cast<double>(time_));
  ended_ = true;
  return false;
}

bool Reader::next(Record& record) {
  if (ended_)
    return false;
  std::array<std::uint8_t, kRecordHeaderSize> head{};
  const std::size_t head_size = readBytes(in_, head.data(), head.size());
  if (head_size == 0) {
    ended_ = true;
    return false;
  }
  if (head_size < head.size())
    return end("is cut off");
  const std::size_t size = head[1];
  const std::int64_t time = endian::load_little_s64(&head[2]);
  if (!isKind(head[0]) || time < time_ || 1e-9 * static_cast<double>(time) > kLongest)
    return end("is damaged");
  record.waited = head[0] == kWaitedKind;
  record.kind = record.waited ? Record::Kind::kReceived : static_cast<Record::Kind>(head[0]);
  if (isReport(record.kind) && (size == 0 || size > protocol::Report::kCapacity))
    return end("is damaged");
  payload_.resize(size);
  if (readBytes(in_, &payload_[0], size) < size)
    return end("is cut off");

  time_ = time;
  position_ += kRecordHeaderSize + size;
  record.time = 1e-9 * static_cast<double>(time);
  if (isReport(record.kind)) {
    record.report.size = size;
    std::copy(payload_.begin(), payload_.end(), record.report.bytes.begin());
  } else if (record.kind == Record::Kind::kConnected) {
    record.remote = remoteOf(payload_);
  } else {
    record.reason = payload_;
  }
  return true;
}

}  // namespace wiimote_tracker::recording
