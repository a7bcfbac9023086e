#pragma once

#include "transport/transport.h"
#include "wiimote_tracker_driver/protocol/report.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// The file format described in doc/recording_format.md.
namespace wiimote_tracker::recording {

/// A recording cannot be used; what() is one sentence that says what to do.
struct BadRecording : transport::TransportError {
  using transport::TransportError::TransportError;
};

/// Header of the file.
struct FileHeader {
  double wall_time = 0.0;  ///< At time 0 of the recording [s since 1970].
  std::string software;    ///< Name and version of the writer.
};

/// One event.
struct Record {
  enum class Kind : std::uint8_t {
    kConnected = 1,
    kReceived = 2,  ///< By the host, from the remote.
    kSent = 3,      ///< By the host, to the remote.
    kDisconnected = 4,
  };
  Kind kind = Kind::kConnected;
  double time = 0.0;         ///< Since the start of the recording [s].
  protocol::Report report;   ///< Of kReceived and kSent.
  transport::Remote remote;  ///< Of kConnected.
  std::string reason;        ///< Of kDisconnected: one sentence; empty: by the host.
  bool waited = false;       ///< Of kReceived: it may have waited to be read.
};

/// In the file: the kind of a received report that may have waited.
constexpr std::uint8_t kWaitedKind = 5;
constexpr std::size_t kMagicSize = 8;
/// The first byte is not text, and the line ends reveal a transfer as text.
constexpr std::uint8_t kMagic[kMagicSize] = {0x89, 'W', 'I', 'I', '\r', '\n', 0x1a, '\n'};
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kFixedHeaderSize = kMagicSize + 4 + 8 + 1;  ///< Then the software's name.
constexpr std::size_t kRecordHeaderSize = 1 + 1 + 8;              ///< Then the payload.
/// Longer texts are truncated [byte].
constexpr std::size_t kLongestPayload = 255;

/// Appends to the file's bytes. Does not allocate if `bytes` has capacity.
void append(const FileHeader& header, std::vector<std::uint8_t>& bytes);
void append(const Record& record, std::vector<std::uint8_t>& bytes);

}  // namespace wiimote_tracker::recording
