#ifndef WIIMOTE_TRACKER_DRIVER_RECORDING_REPLAY_H
#define WIIMOTE_TRACKER_DRIVER_RECORDING_REPLAY_H

#include "recording/format.h"
#include "transport/transport.h"
#include "wiimote_tracker_driver/protocol/input_reports.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace wiimote_tracker::recording {

/// Waits until a time [s] of the recording.
using Pace = std::function<void(double)>;

/// Plays at `speed` [> 0] times the recorded speed, from the first call on.
Pace realTime(double speed = 1.0);

/// Plays a recording once, as a remote. Time is that of the recording and passes only in read(),
/// open() and pass(), so that a session behaves the same at any speed; users of the transport must
/// take the time from here. All recorded reports of the remote arrive at their times. A request is
/// answered by the recorded answer if the recorded host sent the same request at that time, else
/// from what the recording reveals about the remote. Not thread-safe.
class Replay {
 public:
  /// Reads the whole file. Without a `pace` it is played as fast as possible.
  /// @throws BadRecording if the file is not a usable recording.
  explicit Replay(const std::string& path, Pace pace = nullptr);
  ~Replay();

  /// Connects to the remote as it was at this time; waits up to a second for it.
  /// @throws NoSuchDevice if it was not there, or the recording has ended.
  std::unique_ptr<transport::Transport> open();

  /// Time since the start of the recording [s]: exactly that of the last report until time passes.
  /// Starts with the first connection.
  double now() const;

  /// The wall clock of the recording at now() [s since 1970].
  double wallTime() const;

  /// Lets time [s, >= 0] pass while no transport is open.
  void pass(double duration);

  /// Whether the recording has been played to its end.
  bool ended() const;

  /// The infrared format of the recorded images; nothing when there are none.
  std::optional<protocol::IrFormat> irFormat() const;

  /// Sentences for the user if the recording is cut off or was made with other settings; else
  /// empty.
  std::string notice() const;

 private:
  class Transport;
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace wiimote_tracker::recording

#endif  // WIIMOTE_TRACKER_DRIVER_RECORDING_REPLAY_H
