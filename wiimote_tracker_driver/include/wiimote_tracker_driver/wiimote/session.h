#ifndef WIIMOTE_TRACKER_DRIVER_WIIMOTE_SESSION_H
#define WIIMOTE_TRACKER_DRIVER_WIIMOTE_SESSION_H

#include "wiimote_tracker_driver/protocol/input_reports.h"
#include "wiimote_tracker_driver/protocol/output_reports.h"
#include "wiimote_tracker_driver/protocol/report.h"
#include "wiimote_tracker_driver/wiimote/camera_configuration.h"
#include "wiimote_tracker_driver/wiimote/factory_calibration.h"
#include "wiimote_tracker_driver/wiimote/image_assembler.h"
#include "wiimote_tracker_driver/wiimote/session_options.h"
#include "wiimote_tracker_driver/wiimote/stream_watch.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

namespace wiimote_tracker::wiimote {

/// The remote is there but does not do what it is told; what() is one sentence.
struct SessionError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// One connection to a remote, from the first request to the stream of images and its upkeep.
/// Everything is driven by the remote's answers and by deadlines; nothing waits. Others may talk to
/// the same remote (the kernel's own driver does), so foreign answers are expected, memory is
/// matched by address, and the camera's registers are read back, time and again.
class Session {
 public:
  /// Sends a report; may throw, and what it throws passes through.
  using Write = std::function<void(const protocol::Report&)>;

  /// Sends the first request. `now` [s] here and below is any clock that never goes back.
  /// @throws std::invalid_argument when options.ir_format is kNone.
  Session(const SessionOptions& options, Write write, double now);

  /// The remote sent a report. @returns the image that it completes, of the camera as configured.
  /// @throws SessionError when the remote is to be given up.
  std::optional<protocol::DataReport> handle(const protocol::Report& report, double now);

  /// Does what is due. @throws SessionError when the remote is to be given up.
  void tick(double now);

  /// When tick() is next due [s].
  double deadline() const;

  /// Whether the camera is set up and images come.
  bool streaming() const { return images_valid_; }

  /// Sets the camera up with another sensitivity, at once when it is streaming. Images are left out
  /// meanwhile, for five round trips; the report mode stays.
  void setSensitivity(const protocol::IrSensitivity& sensitivity, double now);

  void setLeds(std::uint8_t leds);

  /// The state of the motor goes with every report. Other programs' reports stop it, so it is told
  /// again and again while it is to run.
  void setRumble(bool rumble, double now);

  /// Counts the times the watchdog had to start all over, e.g. after a power cycle that did not
  /// break the connection.
  int restarts() const { return restarts_; }

  /// Counts what was found to be no longer as configured and was put right.
  std::uint64_t restorations() const { return restorations_; }
  /// What was found the last time, one phrase.
  const char* lastRestoration() const { return last_restoration_; }

  /// What the remote's EEPROM says of camera and accelerometer, as far as it was readable.
  const FactoryCalibration& factory() const { return factory_; }

  /// The last status that came.
  const std::optional<protocol::Status>& status() const { return status_; }

  /// Sends what switches reporting, camera, LEDs and motor off. Waits for no answer.
  void switchOff();

 private:
  /// The requests in their order; each waits for its answer.
  enum class Step {
    kStatus,
    kLeds,
    kFactory,
    kIrClock,
    kIrLogic,
    kCameraWrite,  ///< index_: of CameraConfiguration::write().
    kCameraRead,   ///< index_: of CameraConfiguration::read().
    kReportMode,
    kStreaming,
  };

  void enter(Step step, double now);
  void next(double now);
  void send(double now);
  void retry(const std::string& why, double now);
  protocol::Report request() const;
  void transmit(protocol::Report report);
  void setReportMode() { transmit(protocol::setReportMode(assembler_.reportMode(), true)); }

  void handleStatus(const protocol::Status& status, double now);
  void handleMemory(const protocol::MemoryPacket& packet, double now);
  void handleAcknowledgement(const protocol::Acknowledgement& acknowledgement, double now);
  std::optional<protocol::DataReport> handleData(const protocol::Report& report, double now);
  bool isEcho(const protocol::Report& report, double now);
  void otherReport(std::uint8_t id, double now);

  void setUpCamera(double now);
  void writeCamera(double now);
  void checkCamera(int first, int reads, double now);
  void checkPassed(double now);
  void checkFailed(const char* fault, double now);

  void keepStreaming(double now);
  void imagesStopped(double now);
  void startOver(double now);
  void found(const char* what);

  SessionOptions options_;
  Write write_;
  FactoryCalibration factory_;
  CameraConfiguration camera_;
  ImageAssembler assembler_;
  StreamWatch watch_;

  Step step_ = Step::kStatus;
  int index_ = 0;
  int attempts_ = 0;
  double answer_due_ = 0.0;

  bool images_valid_ = false;   ///< The camera is set up.
  int silences_ = 0;            ///< In a row, without an image between them.
  bool after_silence_ = false;  ///< Until the camera has been found to be as it was.
  int restarts_ = 0;

  int reads_left_ = 0;  ///< Of the check under way, with the present one.
  Step after_check_ = Step::kReportMode;
  int next_check_ = 0;          ///< Which part of the configuration has its turn.
  bool write_pending_ = false;  ///< The configuration has changed.
  bool verified_ = false;       ///< Reading the camera's registers back has worked.
  bool verifiable_ = true;      ///< Until it has failed too often without ever having worked.
  int set_ups_ = 0;             ///< Of the camera, without success between them.

  std::optional<double> mode_acknowledged_;  ///< When, with no data report since [s].
  protocol::Report last_data_;
  double last_data_at_ = -std::numeric_limits<double>::infinity();  ///< [s]

  bool rumble_ = false;
  double rumble_due_ = 0.0;

  const char* found_ = nullptr;  ///< What is being put right; null when nothing.
  const char* last_restoration_ = "";
  std::uint64_t restorations_ = 0;

  std::optional<protocol::Status> status_;
};

}  // namespace wiimote_tracker::wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_WIIMOTE_SESSION_H
