#include "recording/format.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::recording {
namespace {

std::uint64_t nanoseconds(double seconds) {
  return static_cast<std::uint64_t>(std::llround(seconds * 1e9));
}

/// The lowest `size` bytes of `value`, lowest first.
void appendLittleEndian(std::uint64_t value, std::size_t size, std::vector<std::uint8_t>& bytes) {
  for (std::size_t i = 0; i < size; ++i)
    bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

/// Identity, kernel driver and description, one per line.
std::string textOf(const transport::Remote& remote) {
  return remote.identity + "\n" + remote.kernel_driver + "\n" + remote.description;
}

}  // namespace

void append(const FileHeader& header, std::vector<std::uint8_t>& bytes) {
  bytes.insert(bytes.end(), std::begin(kMagic), std::end(kMagic));
  appendLittleEndian(kVersion, 4, bytes);
  appendLittleEndian(nanoseconds(header.wall_time), 8, bytes);
  const std::size_t size = std::min(header.software.size(), kLongestPayload);
  bytes.push_back(static_cast<std::uint8_t>(size));
  bytes.insert(bytes.end(), header.software.data(), header.software.data() + size);
}

void append(const Record& record, std::vector<std::uint8_t>& bytes) {
  const auto add = [&](const auto* payload, std::size_t whole) {
    const std::size_t size = std::min(whole, kLongestPayload);
    bytes.push_back(record.waited ? kWaitedKind : static_cast<std::uint8_t>(record.kind));
    bytes.push_back(static_cast<std::uint8_t>(size));
    appendLittleEndian(nanoseconds(record.time), 8, bytes);
    bytes.insert(bytes.end(), payload, payload + size);
  };
  switch (record.kind) {
    case Record::Kind::kReceived:
    case Record::Kind::kSent:
      add(record.report.begin(), record.report.size);
      break;
    case Record::Kind::kConnected: {
      const std::string text = textOf(record.remote);
      add(text.data(), text.size());
      break;
    }
    case Record::Kind::kDisconnected:
      add(record.reason.data(), record.reason.size());
      break;
  }
}

}  // namespace wiimote_tracker::recording
