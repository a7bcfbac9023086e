#ifndef WIIMOTE_TRACKER_DRIVER_WIIMOTE_SESSION_H
#define WIIMOTE_TRACKER_DRIVER_WIIMOTE_SESSION_H

#include "wiimote/camera_configuration.h"
#include "wiimote/factory_calibration.h"
#include "wiimote/image_assembler.h"
#include "wiimote/options.h"
#include "wiimote/stream_watch.h"
#include "wiimote_tracker_driver/protocol/input_reports.h"
#include "wiimote_tracker_driver/protocol/output_reports.h"
#include "wiimote_tracker_driver/protocol/report.h"

#include <wiimote_tracker_msgs/error.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace wiimote_tracker::wiimote {

/// The remote is connected but does not do what it is told; what() is one sentence.
struct SessionError : Error {
  using Error::Error;
};

/// One connection to a remote, from the first request to the stream of images and its upkeep. A
/// state machine, driven by the remote's reports and by deadlines; nothing waits.
///
///   state        request                      after its answer
///   AskStatus    0x15                         SetLeds
///   SetLeds      0x11                         ReadFactory
///   ReadFactory  0x17, EEPROM, 1 of 4 blocks  ReadFactory, or StartClock after the last
///   StartClock   0x13                         StartLogic
///   StartLogic   0x1a                         WriteCamera
///   WriteCamera  0x16, registers, 1 of 5      WriteCamera, or ReadCamera (all) after the last
///   ReadCamera   0x17, registers, 1 of 3      ReadCamera; after the last SetMode or Streaming
///   SetMode      0x12                         Streaming
///   Streaming    none
///
///   event                                     next state
///   no answer in time                         the same, five times; then SessionError, but
///                                             ReadFactory skips a block, ReadCamera has failed,
///                                             and SetLeds, StartClock, StartLogic go on, as does
///                                             SetMode when images come
///   a write is refused, or a register differs StartClock
///   the registers can never be read           SetMode, and they are not read again
///   Streaming: a status came                  SetMode
///   Streaming: check due, other report mode   ReadCamera; WriteCamera when it cannot be read
///   Streaming: no images                      ReadCamera; AskStatus if that does not explain it,
///                                             then SetLeds after a power cycle, else StartClock
///   another sensitivity while set up          WriteCamera
///
/// Other programs may use the same remote (the kernel's driver does). So the session expects
/// answers to requests that are not its own, and matches memory packets by address. When an answer
/// or an image shows that another program may have changed the camera, images are withheld until
/// the registers have been checked.
class Session {
 public:
  /// Sends a report; may throw, and the exception passes through the session.
  using Write = std::function<void(const protocol::Report&)>;

  /// Sends the first request. `now` [s] here and below is any clock that never goes back.
  /// @throws std::invalid_argument when options.ir_format is kNone.
  Session(const Options& options, Write write, double now);

  /// The remote sent a report. @returns the image that it completes, of the camera as configured.
  /// @throws SessionError when the remote is to be given up.
  std::optional<protocol::DataReport> handle(const protocol::Report& report, double now);

  /// Does what is due. @throws SessionError when the remote is to be given up.
  void tick(double now);

  /// When tick() is next due [s].
  double deadline() const;

  /// Whether the camera is set up and images are expected.
  bool streaming() const { return streaming_; }

  /// Sets the camera up with another sensitivity, at once when it is streaming. Images are left out
  /// for five round trips; the report mode stays.
  void setSensitivity(const protocol::IrSensitivity& sensitivity, double now);

  void setLeds(std::uint8_t leds);

  /// Every output report carries the state of the motor, so reports of other programs stop it. It
  /// is therefore repeated while the motor runs.
  void setRumble(bool rumble, double now);

  /// Whether the set-up has begun again from AskStatus since the last call, e.g. after a power
  /// cycle that did not break the connection.
  bool takeRestart() { return std::exchange(restarted_, false); }

  /// What was found changed and has been restored since the last call, a phrase; null: nothing.
  const char* takeRestoration() { return std::exchange(restored_, nullptr); }

  /// Calibration of camera and accelerometer from the remote's EEPROM; unreadable parts are unset.
  const FactoryCalibration& factory() const { return factory_; }

  /// The last status that came.
  const std::optional<protocol::Status>& status() const { return status_; }

  /// Sends what switches reporting, camera, LEDs and motor off. Waits for no answer.
  void switchOff();

 private:
  struct AskStatus {
    bool after_silence = false;  ///< Images did not come: was the remote switched off?
  };
  struct SetLeds {};
  struct ReadFactory {};
  struct StartClock {};
  struct StartLogic {};
  struct WriteCamera {
    int block = 0;               ///< Of CameraConfiguration::write().
    bool after_silence = false;  ///< As in AskStatus.
  };
  struct ReadCamera {
    int block = 0;                           ///< Of CameraConfiguration::read().
    int left = CameraConfiguration::kReads;  ///< Reads left, with this one.
    bool sets_mode = true;                   ///< Then SetMode, else Streaming.
    bool after_silence = false;              ///< As in AskStatus.
  };
  struct SetMode {
    bool camera_changed = false;  ///< Another sensitivity waits to be written.
  };
  struct Streaming {};
  using State = std::variant<AskStatus,
                             SetLeds,
                             ReadFactory,
                             StartClock,
                             StartLogic,
                             WriteCamera,
                             ReadCamera,
                             SetMode,
                             Streaming>;
  template <typename S>
  bool in() const {
    return std::holds_alternative<S>(state_);
  }

  protocol::Report request() const;
  void enter(const State& state, double now);
  void beginStreaming(double now);
  void answered(double now);
  void statusAnswered(AskStatus state, double now);
  void cameraWritten(WriteCamera state, double now);
  void cameraRead(ReadCamera state, double now);

  void send(double now);
  void unanswered(double now);
  void retryOrGiveUp(const std::string& why, double now);
  void transmit(protocol::Report report);
  void sendReportMode() { transmit(protocol::setReportMode(assembler_.reportMode(), true)); }

  void handleStatus(const protocol::Status& status, double now);
  void handleMemory(const protocol::MemoryPacket& packet, double now);
  void handleAcknowledgement(const protocol::Acknowledgement& acknowledgement, double now);
  std::optional<protocol::DataReport> handleData(const protocol::Report& report, double now);
  void handleOtherMode(std::uint8_t id, double now);
  bool withholds(const protocol::DataReport& image, double now);

  void setUpCamera(double now);
  void checkCamera(const ReadCamera& check, double now);
  void checkFailed(const char* fault, bool camera_off, double now);
  void doubtCamera(double now);
  void keepStreaming(double now);
  void imagesStopped(double now);
  void askAfterSilence(double now);
  bool showsPowerCycle(const protocol::Status& status) const;
  void noteFault(const char* fault);

  /// Whether the camera's registers can be read back, as far as known.
  enum class Registers { kUnknown, kReadable, kUnreadable };

  Options options_;
  Write write_;
  FactoryCalibration factory_;
  CameraConfiguration camera_;
  ImageAssembler assembler_;
  StreamWatch watch_;
  std::optional<protocol::Status> status_;

  State state_;
  int attempts_ = 0;         ///< Of the state's request.
  double answer_due_ = 0.0;  ///< [s]

  bool streaming_ = false;  ///< From Streaming on, until the camera is set up again.
  Registers registers_ = Registers::kUnknown;
  int set_ups_ = 0;           ///< Of the camera, in a row without success.
  int silences_ = 0;          ///< In a row, without an image between them.
  int next_check_ = 0;        ///< Block that the next periodic check reads.
  bool restarted_ = false;    ///< Until it is taken.
  bool acknowledges_ = true;  ///< The remote acknowledges LEDs, clock and logic, as far as known.
  bool mode_seen_ = false;    ///< A data report of our mode has come since SetMode.

  bool withhold_ = false;                    ///< No images until the camera has been checked.
  bool implausible_ = false;                 ///< The check is due to an implausible image.
  double implausible_accepted_until_ = 0.0;  ///< [s] After a check that found nothing.

  const char* fault_ = nullptr;     ///< What is being restored; null when nothing.
  const char* restored_ = nullptr;  ///< Until it is taken.

  std::optional<double> rumble_due_;  ///< [s] While the motor runs: when to repeat it.
};

}  // namespace wiimote_tracker::wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_WIIMOTE_SESSION_H
