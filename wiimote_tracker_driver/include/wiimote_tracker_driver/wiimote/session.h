#ifndef WIIMOTE_TRACKER_DRIVER_WIIMOTE_SESSION_H
#define WIIMOTE_TRACKER_DRIVER_WIIMOTE_SESSION_H

#include "wiimote_tracker_driver/protocol/accelerometer.h"
#include "wiimote_tracker_driver/protocol/input_reports.h"
#include "wiimote_tracker_driver/protocol/ir_calibration.h"
#include "wiimote_tracker_driver/protocol/ir_camera.h"
#include "wiimote_tracker_driver/protocol/report.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>

namespace wiimote_tracker::wiimote {

/// The remote is there but does not do what it is told; what() is one sentence.
struct SessionError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// How a session deals with its remote.
struct SessionOptions {
  std::uint8_t leds = 0x1;  ///< Player LEDs 1..4 in bits 0..3, lit while connected.
  /// kBasic (report 0x37), kExtended (0x33), or kFull (0x3e and 0x3f in turn, at half the rate).
  protocol::IrFormat ir_format = protocol::IrFormat::kExtended;
  protocol::IrSensitivity sensitivity = *protocol::irSensitivity("wii_5");
  double reply_timeout = 0.5;     ///< [s, > 0] Then a request is sent again.
  int attempts = 5;               ///< [>= 1] Then the remote is given up.
  double silence_timeout = 0.5;   ///< [s, > 0] Without a report the watchdog acts.
  double dark_check = 0.5;        ///< [s, > 0] Without a light the camera is checked.
  double status_interval = 60.0;  ///< [s, > 0] Between questions for the battery.
};

/// One connection to a remote, from the first request to the stream of images (report 0x33,
/// extended infrared, accelerometer) and its upkeep. Everything is driven by the remote's answers
/// and by deadlines; nothing waits. Others may talk to the same remote (the kernel's own driver
/// does), so foreign answers are expected, memory is matched by address, and the camera's registers
/// are read back.
class Session {
 public:
  /// Sends a report; may throw, and what it throws passes through.
  using Write = std::function<void(const protocol::Report&)>;

  /// Sends the first request. `now` [s] here and below is any clock that never goes back.
  Session(const SessionOptions& options, Write write, double now);

  /// The remote sent a report. @returns it when it is an image of the camera as configured.
  /// @throws SessionError when the remote is to be given up.
  std::optional<protocol::DataReport> handle(const protocol::Report& report, double now);

  /// Does what is due. @throws SessionError when the remote is to be given up.
  void tick(double now);

  /// When tick() is next due [s].
  double deadline() const;

  /// Whether the camera is set up and images come.
  bool streaming() const { return images_valid_; }

  /// Counts the times the watchdog had to start all over, e.g. after a power cycle that did not
  /// break the connection.
  int restarts() const { return restarts_; }

  /// Nothing when the remote's own was not readable; then a typical one serves.
  const std::optional<protocol::AccelerometerCalibration>& accelerometer() const {
    return accelerometer_;
  }

  /// The last status that came.
  const std::optional<protocol::Status>& status() const { return status_; }

  /// Sends what switches reporting, camera and LEDs off. Waits for no answer.
  void switchOff();

 private:
  /// The requests in their order; each waits for its answer.
  enum class Step {
    kStatus,
    kLeds,
    kAccelerometer,
    kAccelerometerCopy,
    kIrClock,
    kIrLogic,
    kIrSetup,
    kIrBlock1,
    kIrBlock2,
    kIrMode,
    kIrRun,
    kIrVerify,
    kReportMode,
    kStreaming,
  };

  void enter(Step step, double now);
  void next(double now);
  void send(double now);
  void retry(const char* why, double now);
  protocol::Report request() const;

  void handleStatus(const protocol::Status& status, double now);
  void handleMemory(const protocol::MemoryPacket& packet, double now);
  void handleAcknowledgement(const protocol::Acknowledgement& acknowledgement, double now);
  std::optional<protocol::DataReport> handleData(const protocol::DataReport& data, double now);

  void setUpCamera(double now);
  void checkCamera(double now);
  void verifyFailed(double now);
  void startOver(double now);

  SessionOptions options_;
  Write write_;

  Step step_ = Step::kStatus;
  int attempts_ = 0;
  double answer_due_ = 0.0;

  bool images_valid_ = false;
  double last_image_ = 0.0;
  double status_due_ = 0.0;
  int silences_ = 0;            ///< In a row, without an image between them.
  bool after_silence_ = false;  ///< Until the camera has been found to be as it was.
  int restarts_ = 0;

  // Darkness is no error, but a camera that somebody switched off looks the same.
  double dark_check_due_ = 0.0;
  double dark_check_interval_ = 0.0;

  bool verified_ = false;   ///< Reading the camera's registers back has worked.
  bool verifiable_ = true;  ///< Until it has failed too often without ever having worked.
  int camera_set_ups_ = 0;  ///< Without an image between them.

  std::optional<protocol::AccelerometerCalibration> accelerometer_;
  std::optional<protocol::Status> status_;
};

}  // namespace wiimote_tracker::wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_WIIMOTE_SESSION_H
