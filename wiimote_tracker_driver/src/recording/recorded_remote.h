#pragma once

#include "recording/format.h"
#include "wiimote_tracker_driver/protocol/input_reports.h"

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>

namespace wiimote_tracker::recording {

/// Whether two output reports are the same request, perhaps with other values (other LEDs, other
/// bytes for the same registers).
bool sameRequest(const protocol::Report& a, const protocol::Report& b);

/// The remote as known from a recording, which answers requests that were not recorded.
class RecordedRemote {
 public:
  /// Learns from a record. Call it for all records before the replay.
  void learn(const Record& record);

  /// The replay has reached this report of the recorded host.
  void recordedHostSent(const protocol::Report& report);
  /// The present host sends this report.
  void hostSends(const protocol::Report& report);

  /// Appends the remote's answers: an acknowledgement, its last status, known memory, or an error.
  void answer(const protocol::Report& request, std::deque<protocol::Report>& answers) const;

  /// Replaces values in a recorded memory packet that the recorded host had written by those that
  /// the present host has written. So the host reads its own settings back, unless the remote had
  /// lost them.
  void putOwnValuesInto(protocol::Report& report) const;

  /// Whether a status was recorded; else answer() invents one.
  bool statusKnown() const { return status_.has_value(); }

  /// Format of the recorded images; nothing when there are none.
  std::optional<protocol::IrFormat> irFormat() const;

  /// Whether the present host has set another sensitivity, or format, than the recorded one.
  bool sensitivityDiffers() const;
  bool formatDiffers() const;

 private:
  /// Address space in bits 24..31, address below.
  using Memory = std::map<std::uint32_t, std::uint8_t>;

  void learnMemory(const protocol::Report& report);
  void answerRead(const protocol::Report& request, std::deque<protocol::Report>& answers) const;
  bool differs(std::uint32_t first, std::uint32_t last) const;

  std::optional<protocol::Report> status_;  ///< The last one.
  Memory memory_;    ///< As the recorded host read it, and the present one wrote it.
  Memory settings_;  ///< As the recorded host wrote it last in the whole recording.
  std::array<std::uint64_t, 256> received_{};  ///< Per report id.

  protocol::Report recorded_read_;  ///< Last memory request of the recorded host.
  protocol::Report own_read_;       ///< Last memory request of the present host.
  Memory recorded_values_;          ///< Written by the recorded host up to this time.
  Memory own_values_;               ///< Written by the present host.
};

}  // namespace wiimote_tracker::recording
