#ifndef WIIMOTE_TRACKER_DRIVER_RECORDING_RECORDED_REMOTE_H
#define WIIMOTE_TRACKER_DRIVER_RECORDING_RECORDED_REMOTE_H

#include "wiimote_tracker_driver/protocol/input_reports.h"
#include "wiimote_tracker_driver/recording/format.h"

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>

namespace wiimote_tracker::recording {

/// Whether two output reports ask for the same thing, though perhaps with other values: other LEDs,
/// other bytes to the same registers.
bool sameRequest(const protocol::Report& a, const protocol::Report& b);

/// What a recording tells about its remote, enough to answer requests that were not made then.
class RecordedRemote {
 public:
  /// To be told all records in advance.
  void learn(const Record& record);

  /// The recorded host sent this, at the time that is now.
  void recordedHostSent(const protocol::Report& report);
  /// The present host sends this.
  void hostSends(const protocol::Report& report);

  /// What the remote says to it, appended to `answers`: acknowledgements, its last status, and
  /// memory as far as it is known, else an error.
  void answer(const protocol::Report& request, std::deque<protocol::Report>& answers) const;

  /// A recorded piece of memory holds what the recorded host had written there. Puts in its place
  /// what the present host wrote, so that it finds its own settings, unless the remote had lost
  /// them.
  void putOwnValuesInto(protocol::Report& report) const;

  /// Nothing when there are no images.
  std::optional<protocol::IrFormat> irFormat() const;

  /// Whether the present host has set the camera's sensitivity to another value than the recorded
  /// one; its format.
  bool sensitivityDiffers() const;
  bool formatDiffers() const;

 private:
  /// Address space in bits 24..31, address below.
  using Memory = std::map<std::uint32_t, std::uint8_t>;

  void learnMemory(const protocol::Report& report);
  void answerRead(const protocol::Report& request, std::deque<protocol::Report>& answers) const;
  bool differs(std::uint32_t first, std::uint32_t last) const;

  protocol::Report status_{0x20, 0, 0, 0, 0, 0, 0};
  Memory memory_;                              ///< As read by the recorded host, at any time.
  Memory settings_;                            ///< As written by the recorded host at last.
  std::array<std::uint64_t, 256> received_{};  ///< Per report id.

  protocol::Report recorded_read_;  ///< The last request of the recorded host for memory.
  protocol::Report own_read_;       ///< The same of the present one.
  Memory recorded_values_;          ///< As written by the recorded host up to now.
  Memory own_values_;               ///< As written by the present one.
};

}  // namespace wiimote_tracker::recording

#endif  // WIIMOTE_TRACKER_DRIVER_RECORDING_RECORDED_REMOTE_H
