#ifndef WIIMOTE_TRACKER_DRIVER_RECORDING_REPLAY_H
#define WIIMOTE_TRACKER_DRIVER_RECORDING_REPLAY_H

#include "wiimote_tracker_driver/protocol/input_reports.h"
#include "wiimote_tracker_driver/recording/format.h"
#include "wiimote_tracker_driver/transport/transport.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace wiimote_tracker::recording {

/// Returns when this time [s] of the recording has come.
using Pace = std::function<void(double)>;

/// `speed` [> 0] times as fast as it was; the first call starts it.
Pace realTime(double speed = 1.0);

/// A recording as a remote, played once. Time is the recording's own, and passes only in read(),
/// open() and pass(), so that the same session does the same at any speed; whoever uses the
/// transport takes its clock from here. Everything that the remote said is said again at its time.
/// What the host asks is answered by that if the host asked the same then, otherwise from what the
/// recording tells about the remote: the session always gets its answers, whatever its settings.
/// Not thread-safe.
class Replay {
 public:
  /// Reads through the file once. `pace`: none: as fast as possible.
  /// @throws BadRecording when there is no recording in the file.
  explicit Replay(const std::string& path, Pace pace = nullptr);
  ~Replay();

  /// Connects to the remote as it was at this time, waiting up to a second for it.
  /// @throws NoSuchDevice when it was not there, or when the recording has ended.
  std::unique_ptr<transport::Transport> open();

  /// [s] Since the beginning of the recording; exactly the recorded time of the report that was
  /// read last, until time passes. Starts with the first connection.
  double now() const;

  /// [s since 1970] The wall clock of the recording at now().
  double wallTime() const;

  /// Lets time [s, >= 0] pass while no transport is open.
  void pass(double duration);

  /// Whether all has been played.
  bool ended() const;

  /// The infrared format of the recorded images, which no setting can change any more; nothing when
  /// there are none.
  std::optional<protocol::IrFormat> irFormat() const;

  /// What people should know about this recording, in sentences: it is cut off, or was made with
  /// other settings than those of the session; empty when nothing.
  std::string notice() const;

 private:
  class Transport;
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace wiimote_tracker::recording

#endif  // WIIMOTE_TRACKER_DRIVER_RECORDING_REPLAY_H
