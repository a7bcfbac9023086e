#pragma once

#include "file_descriptor.h"
#include "recording/format.h"
#include "transport/transport.h"
#include "wiimote_tracker_driver/protocol/report.h"

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace wiimote_tracker::recording {

/// Writes the reports between host and remote to a file. The calls only copy into memory; a thread
/// writes once a second, so that a slow disk delays no report and a crash loses at most a second. A
/// file error ends only the recording. Times [s] are of any monotonic clock. Only error() may be
/// called by another thread.
class Recorder {
 public:
  /// Creates the file. If "name.wiirec" exists, the new file is "name_2.wiirec" and so on.
  /// `wall_time` [s since 1970] corresponds to `now`. @throws BadRecording if it cannot be created.
  Recorder(const std::string& path, double now, double wall_time);
  /// As finish().
  ~Recorder() { finish(); }
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  void connected(const transport::Remote& remote, double now) {
    add({Record::Kind::kConnected, now, {}, remote, ""});
  }
  /// @param waited whether it may have waited to be read.
  void received(const protocol::Report& report, double now, bool waited = false) {
    add({Record::Kind::kReceived, now, report, {}, "", waited});
  }
  void sent(const protocol::Report& report, double now) {
    add({Record::Kind::kSent, now, report, {}, ""});
  }
  /// `reason`: one sentence; empty when the host disconnected.
  void disconnected(const std::string& reason, double now) {
    add({Record::Kind::kDisconnected, now, {}, {}, reason});
  }

  /// Path of the file.
  const std::string& path() const { return path_; }

  /// Why the recording ended early, one sentence; empty while it is written.
  std::string error() const;

  /// Writes the rest. Nothing can be added any more. @returns error()
  std::string finish();

 private:
  void add(Record record);
  void run();
  std::string write() const;
  std::string close();
  void fail(const std::string& why);

  std::string path_;
  const double begin_;  ///< [s]

  mutable std::mutex mutex_;  ///< Guards filling_, error_ and stop_.
  std::condition_variable wake_;
  std::vector<std::uint8_t> filling_;
  std::string error_;
  bool stop_ = false;

  // Used only by the thread:
  std::vector<std::uint8_t> writing_;
  FileDescriptor fd_;

  std::thread thread_;
};

/// Wraps `transport` so that `recorder` records every report, at the time of `clock` [s].
std::unique_ptr<transport::Transport> record(std::unique_ptr<transport::Transport> transport,
                                             std::shared_ptr<Recorder> recorder,
                                             std::function<double()> clock);

}  // namespace wiimote_tracker::recording
