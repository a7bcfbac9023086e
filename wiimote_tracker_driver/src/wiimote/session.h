#pragma once

#include "wiimote/camera_configuration.h"
#include "wiimote/factory_calibration.h"
#include "wiimote/image_assembler.h"
#include "wiimote/image_gate.h"
#include "wiimote/options.h"
#include "wiimote/output.h"
#include "wiimote/stream_watch.h"
#include "wiimote_tracker_driver/protocol/input_reports.h"
#include "wiimote_tracker_driver/protocol/output_reports.h"
#include "wiimote_tracker_driver/protocol/report.h"

#include <wiimote_tracker_msgs/error.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace wiimote_tracker::wiimote {

/// The remote is connected but does not do what it is told; what() is one sentence.
struct SessionError : Error {
  using Error::Error;
};

/// One connection to a remote, from the first request to the stream of images and its upkeep. A
/// state machine, driven by the remote's reports and by deadlines; nothing waits. row() is its
/// state diagram, but for these transitions:
///
///   event                                     next state
///   a register differs from what was written  kStartClock
///   the registers can never be read           kSetMode, and they are not read again
///   another sensitivity while set up          kWriteCamera
///   kStreaming: a status came                 kSetMode
///   kStreaming: other report mode, or a check kReadCamera, kCheckBlock; kWriteCamera when the
///   is due (StreamWatch)                      registers cannot be read
///   no images, and no register explains it,   kAskWhySilent
///   or the camera is off
///
/// Other programs may use the same remote (the kernel's driver does). So the session expects
/// answers to requests that are not its own, and matches memory packets by address. When an answer
/// or an image shows that another program may have changed the camera, images are withheld until
/// the registers have been checked.
class Session {
 public:
  /// Sends the first request. `now` [s] here and below is any clock that never goes back.
  /// @throws std::invalid_argument when options.ir_format is kNone.
  Session(const Options& options, Output::Write write, double now);

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

  void setRumble(bool rumble, double now) { output_.setRumble(rumble, now); }

  /// Whether the remote was switched off and on since the last call, which did not break the
  /// connection.
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
  enum State {
    kAskStatus,
    kSetLeds,
    kReadFactory,  ///< A block of the EEPROM.
    kStartClock,
    kStartLogic,
    kWriteCamera,  ///< Block `block_` of the registers.
    kReadCamera,   ///< The same.
    kSetMode,
    kStreaming,
    kCheckBlock,    ///< One block of the registers.
    kAskWhySilent,  ///< Images do not come: was the remote switched off?
  };
  using Action = void (Session::*)(double now);
  static constexpr Action kGiveUp = nullptr;  ///< SessionError.
  /// A state: what it requests, and what follows.
  struct Row {
    protocol::Report request;
    int attempts = 0;          ///< How often it is sent, each time reply_timeout later.
    State next = kStreaming;   ///< Once the remote has answered; if the same: the next block.
    Action silent = kGiveUp;   ///< When it has not, after the last attempt.
    Action refused = kGiveUp;  ///< When it has answered with an error.
  };
  Row row() const;
  State nextBlock(int blocks, State then) const { return block_ + 1 < blocks ? state_ : then; }

  bool in(State state) const { return state_ == state; }
  bool inCamera() const { return in(kWriteCamera) || in(kReadCamera) || in(kCheckBlock); }
  void enter(State state, double now, int block = 0);
  void answered(double now);
  void goOnUnacknowledged(double now);
  void skipFactory(double now);
  void checkUnanswered(double now) { checkFailed(nullptr, false, now); }
  void setUpCamera(double now);

  void send(double now);
  void repeat(int attempts, Action then, const std::string& why, double now);
  protocol::Report modeRequest() const {
    return protocol::setReportMode(assembler_.reportMode(), true);
  }

  void handleStatus(const protocol::Status& status, double now);
  void handleMemory(const protocol::MemoryPacket& packet, double now);
  void handleAcknowledgement(const protocol::Acknowledgement& acknowledgement, double now);
  std::optional<protocol::DataReport> handleData(const protocol::Report& report, double now);
  void noteImage(const protocol::DataReport& image, double now);
  void handleOtherMode(std::uint8_t id, double now);

  void beginStreaming(double now);
  void keepStreaming(double now);
  void checkCamera(State check, int block, double now);
  void checkFailed(const char* fault, bool camera_off, double now);
  void doubtCamera(double now);
  void askWhySilent(double now);
  void noteFault(const char* fault);

  /// Whether the camera's registers can be read back, as far as known.
  enum class Registers { kUnknown, kReadable, kUnreadable };

  Options options_;
  Output output_;
  FactoryCalibration factory_;
  CameraConfiguration camera_;
  ImageAssembler assembler_;
  ImageGate gate_;
  StreamWatch watch_;
  std::optional<protocol::Status> status_;

  State state_ = kAskStatus;
  int block_ = 0;
  int attempts_ = 0;             ///< Of the state's request.
  double answer_due_ = 0.0;      ///< [s]
  bool mode_seen_ = false;       ///< A data report of our mode has come in this state.
  bool camera_changed_ = false;  ///< In kSetMode: another sensitivity waits to be written.
  bool after_silence_ = false;   ///< In checks of the camera: they may explain why images stopped.

  bool streaming_ = false;    ///< From kStreaming on, until the camera is set up again.
  bool restarted_ = false;    ///< Until it is taken.
  bool acknowledges_ = true;  ///< The remote acknowledges LEDs, clock and logic, as far as known.
  Registers registers_ = Registers::kUnknown;
  int set_ups_ = 0;  ///< Of the camera, in a row without success.

  const char* fault_ = nullptr;     ///< What is being restored; null when nothing.
  const char* restored_ = nullptr;  ///< Until it is taken.
};

}  // namespace wiimote_tracker::wiimote
