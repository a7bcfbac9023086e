#pragma once

#include "recording/reader.h"
#include "recording/recorded_remote.h"
#include "transport/transport.h"
#include "wiimote_tracker_driver/protocol/input_reports.h"

#include <deque>
#include <fstream>
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

  Replay(const Replay&) = delete;
  Replay& operator=(const Replay&) = delete;

  /// Connects to the remote as it was at this time; waits up to a second for it. The transport must
  /// not outlive this. @throws NoSuchDevice if it was not there, or the recording has ended.
  std::unique_ptr<transport::Transport> open();

  /// Time since the start of the recording [s]: exactly that of the last report until time passes.
  /// Starts with the first connection.
  double now() const { return now_; }

  /// The wall clock of the recording at now() [s since 1970].
  double wallTime() const { return reader_.header().wall_time + now_; }

  /// Lets time [s, >= 0] pass while no transport is open.
  void pass(double duration) { passUntil(now_ + duration); }

  /// Whether the recording has been played to its end.
  bool ended() const { return ended_; }

  /// Whether the recording has a status; else the one that the remote answers means nothing.
  bool statusKnown() const { return remote_.statusKnown(); }

  /// The infrared format of the recorded images; nothing when there are none.
  std::optional<protocol::IrFormat> irFormat() const { return remote_.irFormat(); }

  /// Sentences for the user if the recording is cut off or was made with other settings; else
  /// empty.
  std::string notice() const;

 private:
  class Transport;

  struct Event {
    Record record;
    bool matched = false;  ///< A request that the present host has sent, too.
  };

  void learn();
  void passUntil(double time);
  bool readAhead(double time);
  Record take();
  std::string end();
  bool read(protocol::Report& report, double timeout);
  [[noreturn]] void disconnect(const std::string& reason);
  void write(const protocol::Report& report);

  const std::string path_;
  const Pace pace_;
  std::ifstream file_;
  Reader reader_;
  double now_ = 0.0;
  bool ended_ = false;
  bool connected_ = false;
  transport::Remote description_;
  RecordedRemote remote_;
  std::string damage_;
  std::deque<Event> ahead_;  ///< Read but not yet played.
  std::deque<protocol::Report> answers_;
};

}  // namespace wiimote_tracker::recording
