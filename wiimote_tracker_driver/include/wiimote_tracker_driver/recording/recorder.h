#ifndef WIIMOTE_TRACKER_DRIVER_RECORDING_RECORDER_H
#define WIIMOTE_TRACKER_DRIVER_RECORDING_RECORDER_H

#include "wiimote_tracker_driver/protocol/report.h"
#include "wiimote_tracker_driver/recording/format.h"
#include "wiimote_tracker_driver/transport/transport.h"

#include <functional>
#include <memory>
#include <string>

namespace wiimote_tracker::recording {

/// Writes what passes between host and remote to a file. The calls only copy into memory; a thread
/// of its own writes about once a second, so that a slow disk delays no report, and a crash loses
/// the last second. What goes wrong with the file ends the recording and nothing else. Times [s]
/// are of any clock that never goes back. Only error() may be called by another thread.
class Recorder {
 public:
  /// Creates the file. One that exists is kept: "name.wiirec" then becomes "name_2.wiirec" and so
  /// on. `wall_time` [s since 1970] belongs to `now`.
  /// @throws BadRecording when the file cannot be created.
  Recorder(const std::string& path, double now, double wall_time);
  /// Writes the rest.
  ~Recorder();

  void connected(const Remote& remote, double now);
  void received(const protocol::Report& report, double now);
  void sent(const protocol::Report& report, double now);
  /// `reason`: one sentence; empty when it was the host's own wish.
  void disconnected(const std::string& reason, double now);

  /// Where the recording goes.
  const std::string& path() const;

  /// Why the recording has ended too early, one sentence; empty while all is well.
  std::string error() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A transport that does what `transport` does and has `recorder` write it down. `clock` [s] is
/// asked at each report.
std::unique_ptr<transport::Transport> record(std::unique_ptr<transport::Transport> transport,
                                             std::shared_ptr<Recorder> recorder,
                                             std::function<double()> clock);

}  // namespace wiimote_tracker::recording

#endif  // WIIMOTE_TRACKER_DRIVER_RECORDING_RECORDER_H
