#ifndef WIIMOTE_TRACKER_DRIVER_WIIMOTE_WIIMOTE_H
#define WIIMOTE_TRACKER_DRIVER_WIIMOTE_WIIMOTE_H

#include "wiimote_tracker_driver/transport/transport.h"
#include "wiimote_tracker_driver/wiimote/session.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace wiimote_tracker::wiimote {

struct Options {
  SessionOptions session;
  double retry_min = 0.25;  ///< [s, > 0] Pause after the first failure; doubles with each further.
  double retry_max = 0.5;   ///< [s, >= retry_min] Longest pause.
};

/// The state of the connection, for people and for messages.
struct Link {
  enum class State {
    kSearching,  ///< No remote is open.
    kStarting,   ///< It is being set up.
    kStreaming,  ///< Images come.
  };
  State state = State::kSearching;
  std::string error;          ///< Why it is not streaming, one sentence; empty when all is well.
  std::string description;    ///< Of the transport that is or was open last.
  std::string identity;       ///< Bluetooth address of the remote that is or was open last.
  std::string kernel_driver;  ///< Attached beside us; empty when none.
  std::uint32_t clock_epoch = 0;  ///< Counts from 0, one more at each reconnect or power cycle.
  std::optional<protocol::Status> status;
  bool accelerometer_calibrated = false;  ///< By the remote's own EEPROM.
  /// From the remote's EEPROM; nothing when it is damaged.
  std::optional<protocol::IrCalibration> ir_calibration;
  /// How often the remote's configuration was found to be no longer ours and put right, since the
  /// beginning.
  std::uint64_t restorations = 0;
  std::string last_restoration;  ///< What was found, one phrase: "the camera was switched off".
};

/// A remote that is connected as long as there is one: opens it, streams from it, and starts again
/// for ever when it has gone away or was never there. Not thread-safe: the thread that calls step()
/// calls all else.
class Wiimote {
 public:
  /// Opens the transport or throws TransportError.
  using Open = std::function<std::unique_ptr<transport::Transport>()>;
  /// Any clock that never goes back [s].
  using Clock = std::function<double()>;

  Wiimote(const Options& options, Open open, Clock clock);
  ~Wiimote();

  /// One turn: opens the remote if that is due, else waits up to `max_wait` [s] for one report and
  /// handles it. @returns the report when it is an image. Never throws for what a remote may do;
  /// link() tells.
  std::optional<protocol::DataReport> step(double max_wait);

  /// How long step() will have nothing to do but return at once [s]; 0 while connected.
  double idleTime() const;

  const Link& link() const { return link_; }

  /// Grows whenever link() has changed.
  std::uint64_t linkChanges() const { return link_changes_; }

  /// Of the connected remote, or typical values.
  const protocol::AccelerometerCalibration& accelerometer() const { return accelerometer_; }

  /// Changes how sensitive the camera is, now and after each reconnect. Images are left out for
  /// some ten frames and go on in the same clock epoch.
  void setSensitivity(const protocol::IrSensitivity& sensitivity);

  /// Player LEDs 1..4 in bits 0..3, now and after each reconnect.
  void setLeds(std::uint8_t leds);

  /// Runs the motor, until told otherwise or until the connection is lost. It shakes the camera.
  void setRumble(bool rumble);

  /// Switches the remote's reporting, camera and LEDs off and lets it go.
  void close();

 private:
  /// Ends the connection when the action throws what a remote may cause.
  template <typename Action>
  void orDrop(Action action);

  void connect();
  void drop(const std::string& error);
  std::optional<protocol::DataReport> receive(double max_wait);
  void updateLink(bool image);

  Options options_;
  const Open open_;
  const Clock clock_;

  std::unique_ptr<transport::Transport> transport_;
  std::optional<Session> session_;
  double retry_pause_;
  double next_attempt_;

  Link link_;
  std::uint64_t link_changes_ = 0;
  protocol::AccelerometerCalibration accelerometer_;
  bool had_image_ = false;
  bool new_epoch_ = false;          ///< The next image is the first of another epoch.
  int restarts_ = 0;                ///< Of the session, as far as seen.
  std::uint64_t restorations_ = 0;  ///< Likewise.
};

}  // namespace wiimote_tracker::wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_WIIMOTE_WIIMOTE_H
