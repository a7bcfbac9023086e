#ifndef WIIMOTE_TRACKER_DRIVER_RECORDING_FORMAT_H
#define WIIMOTE_TRACKER_DRIVER_RECORDING_FORMAT_H

#include "transport/transport.h"
#include "wiimote_tracker_driver/protocol/report.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// The file that doc/recording_format.md describes.
namespace wiimote_tracker::recording {

/// What goes wrong with a recording; what() is one sentence that says what to do.
struct BadRecording : transport::TransportError {
  using transport::TransportError::TransportError;
};

/// At the beginning of the file.
struct Header {
  double wall_time = 0.0;  ///< [s since 1970] At time 0 of the recording.
  std::string software;    ///< That wrote it, with its version.
};

/// Who is at the other end of a connection; the same as Transport tells.
struct Remote {
  std::string identity;
  std::string description;
  std::string kernel_driver;
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
  double time = 0.0;        ///< [s] Since the beginning of the recording.
  protocol::Report report;  ///< Of kReceived and kSent.
  Remote remote;            ///< Of kConnected.
  std::string reason;       ///< Of kDisconnected: one sentence; empty: the host wanted it.
};

constexpr std::size_t kMagicSize = 8;
/// The first byte is no text and the line ends show what has been sent as text.
constexpr std::uint8_t kMagic[kMagicSize] = {0x89, 'W', 'I', 'I', '\r', '\n', 0x1a, '\n'};
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kFixedHeaderSize = kMagicSize + 4 + 8 + 1;  ///< Then the software's name.
constexpr std::size_t kRecordHeaderSize = 1 + 1 + 8;              ///< Then the payload.
/// Longer texts are cut off [byte].
constexpr std::size_t kLongestPayload = 255;

/// Append what belongs into the file. No allocation where `bytes` has room.
void append(const Header& header, std::vector<std::uint8_t>& bytes);
void append(const Record& record, std::vector<std::uint8_t>& bytes);

}  // namespace wiimote_tracker::recording

#endif  // WIIMOTE_TRACKER_DRIVER_RECORDING_FORMAT_H
