#include "recording/format.h"

#include "little_endian.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::recording {
namespace {

std::uint64_t nanoseconds(double seconds) {
  return static_cast<std::uint64_t>(std::llround(seconds * 1e9));
}

void appendText(const std::string& text, std::size_t size, std::vector<std::uint8_t>& bytes) {
  bytes.insert(bytes.end(), text.begin(), text.begin() + static_cast<std::ptrdiff_t>(size));
}

/// Identity, kernel driver and description, one per line.
std::string textOf(const transport::Remote& remote) {
  std::string text = remote.identity + "\n" + remote.kernel_driver + "\n" + remote.description;
  text.resize(std::min(text.size(), kLongestPayload));
  return text;
}

void appendRecordHeader(const Record& record,
                        std::size_t payload_size,
                        std::vector<std::uint8_t>& bytes) {
  bytes.push_back(static_cast<std::uint8_t>(record.kind));
  bytes.push_back(static_cast<std::uint8_t>(payload_size));
  appendLittleEndian(nanoseconds(record.time), 8, bytes);
}

}  // namespace

void append(const FileHeader& header, std::vector<std::uint8_t>& bytes) {
  bytes.insert(bytes.end(), std::begin(kMagic), std::end(kMagic));
  appendLittleEndian(kVersion, 4, bytes);
  appendLittleEndian(nanoseconds(header.wall_time), 8, bytes);
  const std::size_t size = std::min(header.software.size(), kLongestPayload);
  bytes.push_back(static_cast<std::uint8_t>(size));
  appendText(header.software, size, bytes);
}

void append(const Record& record, std::vector<std::uint8_t>& bytes) {
  switch (record.kind) {
    case Record::Kind::kReceived:
    case Record::Kind::kSent:
      appendRecordHeader(record, record.report.size, bytes);
      bytes.insert(bytes.end(), record.report.begin(), record.report.end());
      break;
    case Record::Kind::kConnected: {
      const std::string text = textOf(record.remote);
      appendRecordHeader(record, text.size(), bytes);
      appendText(text, text.size(), bytes);
      break;
    }
    case Record::Kind::kDisconnected: {
      const std::size_t size = std::min(record.reason.size(), kLongestPayload);
      appendRecordHeader(record, size, bytes);
      appendText(record.reason, size, bytes);
      break;
    }
  }
}

}  // namespace wiimote_tracker::recording
