#pragma once

#include "transport/queue_watch.h"
#include "transport/transport.h"
#include "wiimote/session.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace wiimote_tracker::wiimote {

/// The state of the connection with the remote that is or was open last.
struct Link {
  enum class State {
    kSearching,  ///< No remote is open.
    kStarting,   ///< It is being set up.
    kStreaming,  ///< Images come.
  };
  transport::Remote remote;
  State state = State::kSearching;
  std::string error;              ///< Why it is not streaming, one sentence; else empty.
  std::uint32_t clock_epoch = 0;  ///< Counts from 0, one more at each reconnect or power cycle.
  std::optional<protocol::Status> status;
  bool accelerometer_calibrated = false;  ///< By the remote's own EEPROM.
  bool accelerometer_unknown = false;     ///< That could not be read, so it may be undamaged.
  /// From the remote's EEPROM; nothing when it is damaged.
  std::optional<protocol::IrCalibration> ir_calibration;
  /// How often the remote's configuration was found changed and was restored, since the beginning.
  std::uint64_t restorations = 0;
  std::string last_restoration;  ///< What was found, a phrase: "the camera was switched off".
};

/// Keeps a remote connected: opens it, streams from it, and reconnects forever. Not thread-safe:
/// the thread that calls step() calls everything else.
class Wiimote {
 public:
  /// Any clock that never goes back [s].
  using Clock = std::function<double()>;

  Wiimote(const Options& options, transport::Opener open, Clock clock);
  ~Wiimote();

  /// Opens the remote if that is due, else waits up to `max_wait` [s] for one report and handles
  /// it. Never throws: an exception of transport or session ends the connection, and link() has its
  /// text. @returns the image, if the report completes one. When reports have waited for more than
  /// 0.6 s, because the caller did not read or reads too slowly, images are dropped until none
  /// waits: the kernel keeps the oldest 63 reports, so these are of an unknown time before those
  /// that were lost. A clock epoch begins with an image that did not wait.
  std::optional<protocol::DataReport> step(double max_wait);

  /// Whether the image that step() returned last may have waited for more than 2 ms, so that the
  /// time now does not tell when it arrived.
  bool imageWaited() const { return queue_.waited(); }

  /// Time until step() will have something to do [s]; 0 while connected.
  double idleTime() const;

  const Link& link() const { return link_; }

  /// Grows whenever link() has changed.
  std::uint64_t linkChanges() const { return link_changes_; }

  /// Of the connected remote, or typical values.
  const protocol::AccelerometerCalibration& accelerometer() const { return accelerometer_; }

  /// Changes the camera's sensitivity, now and after each reconnect. Images are left out for five
  /// round trips; the clock epoch stays.
  void setSensitivity(const protocol::IrSensitivity& sensitivity);

  /// Player LEDs 1..4 in bits 0..3, now and after each reconnect.
  void setLeds(std::uint8_t leds);

  /// Runs the motor until it is switched off or the connection is lost. It shakes the camera.
  void setRumble(bool rumble);

  /// Switches the remote's reporting, camera and LEDs off and disconnects.
  void close();

 private:
  /// Ends the connection when the action throws.
  template <typename Action>
  void dropOnException(Action action);

  void connect();
  void drop(const std::string& error);
  bool read(protocol::Report& report, double wait);
  std::optional<protocol::DataReport> receive(double max_wait);
  void updateLink(bool image);

  Options options_;
  const transport::Opener open_;
  const Clock clock_;

  std::unique_ptr<transport::Transport> transport_;
  std::optional<Session> session_;
  double retry_pause_;
  double next_attempt_;

  Link link_;
  std::uint64_t link_changes_ = 0;
  protocol::AccelerometerCalibration accelerometer_;
  transport::QueueWatch queue_{0.0};
  bool backlog_ = false;      ///< Reports have waited for too long.
  bool delivered_ = false;    ///< Images have come from the remote that was opened last.
  std::uint32_t epochs_ = 0;  ///< Of the clock, that have begun since the start.
  bool begins_epoch_ = true;  ///< The next image begins one.
};

}  // namespace wiimote_tracker::wiimote
