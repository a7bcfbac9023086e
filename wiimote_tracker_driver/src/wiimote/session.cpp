#include "wiimote/session.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace wiimote_tracker::wiimote {
namespace {

using protocol::Report;

constexpr std::uint8_t kErrorBusy = 4;
// Of a request, after which the remote is given up.
constexpr int kAttempts = 5;
// Pause before a read is repeated that the remote refused as busy [s]; doubles each time.
constexpr double kFirstBusyPause = 0.04;
// Implausible images pass for this long after a check has found the camera as configured [s]: some
// remote may always send such images.
constexpr double kImplausibleAccepted = 10.0;

constexpr double kForever = std::numeric_limits<double>::infinity();

}  // namespace

Session::Session(const Options& options, Write write, double now)
    : options_(options),
      write_(std::move(write)),
      camera_(options.sensitivity, options.ir_format),
      assembler_(options.ir_format),
      watch_(options),
      state_(AskStatus{}) {
  enter(AskStatus{}, now);
}

// ---- States: the request of each, and the state after its answer

Report Session::request() const {
  if (in<AskStatus>())
    return protocol::requestStatus();
  if (in<SetLeds>())
    return protocol::setLeds(options_.leds);
  if (in<ReadFactory>())
    return factory_.request();
  if (in<StartClock>())
    return protocol::setIrClock(true);
  if (in<StartLogic>())
    return protocol::setIrLogic(true);
  if (const auto* state = std::get_if<WriteCamera>(&state_))
    return camera_.write(state->block);
  if (const auto* state = std::get_if<ReadCamera>(&state_))
    return camera_.read(state->block);
  return protocol::setReportMode(assembler_.reportMode(), true);
}

void Session::answered(double now) {
  if (const auto* ask = std::get_if<AskStatus>(&state_)) {
    statusAnswered(*ask, now);
  } else if (in<SetLeds>()) {
    factory_ = FactoryCalibration();
    enter(ReadFactory{}, now);
  } else if (in<ReadFactory>()) {
    enter(factory_.complete() ? State(StartClock{}) : ReadFactory{}, now);
  } else if (in<StartClock>()) {
    enter(StartLogic{}, now);
  } else if (in<StartLogic>()) {
    enter(WriteCamera{}, now);
  } else if (const auto* write = std::get_if<WriteCamera>(&state_)) {
    cameraWritten(*write, now);
  } else if (const auto* check = std::get_if<ReadCamera>(&state_)) {
    cameraRead(*check, now);
  } else if (const auto* mode = std::get_if<SetMode>(&state_)) {
    const bool camera_changed = mode->camera_changed;
    enter(Streaming{}, now);
    if (camera_changed)
      enter(WriteCamera{}, now);
  }
}

void Session::statusAnswered(AskStatus state, double now) {
  if (state.after_silence && !showsPowerCycle(*status_)) {
    enter(StartClock{}, now);
    return;
  }
  if (state.after_silence) {
    fault_ = "the remote was switched off and on";
    restarted_ = true;
  }
  enter(SetLeds{}, now);
}

void Session::cameraWritten(WriteCamera state, double now) {
  if (++state.block < CameraConfiguration::kWrites)
    enter(state, now);
  else if (registers_ == Registers::kUnreadable)
    enter(SetMode{}, now);
  else
    enter(ReadCamera{0, CameraConfiguration::kReads, true, state.after_silence}, now);
}

void Session::cameraRead(ReadCamera state, double now) {
  if (--state.left > 0) {
    state.block = (state.block + 1) % CameraConfiguration::kReads;
    enter(state, now);
    return;
  }
  registers_ = Registers::kReadable;
  set_ups_ = 0;
  if (state.after_silence)
    watch_.expectImage(now);
  enter(state.sets_mode ? State(SetMode{}) : Streaming{}, now);
}

void Session::enter(const State& state, double now) {
  state_ = state;
  attempts_ = 0;
  mode_seen_ = false;
  if (in<Streaming>())
    beginStreaming(now);
  else
    send(now);
}

void Session::beginStreaming(double now) {
  if (!streaming_)
    watch_.start(now);
  streaming_ = true;
  withhold_ = watch_.doubted();
  const bool readable = registers_ != Registers::kUnreadable;
  if (std::exchange(implausible_, false))
    implausible_accepted_until_ = now + (readable ? kImplausibleAccepted : kForever);
  if (!readable)
    set_ups_ = 0;
}

// ---- Requests

void Session::send(double now) {
  ++attempts_;
  answer_due_ = now + options_.reply_timeout;
  transmit(request());
}

void Session::transmit(Report report) {
  if (rumble_due_)
    report.bytes[1] |= protocol::kRumbleBit;
  write_(report);
}

// Some remotes do not acknowledge all commands. That LEDs, clock and logic are on shows later.
void Session::unanswered(double now) {
  const bool command = in<SetLeds>() || in<StartClock>() || in<StartLogic>();
  if (in<SetMode>() && mode_seen_) {
    answered(now);
  } else if (command && (!acknowledges_ || attempts_ >= kAttempts)) {
    acknowledges_ = false;
    answered(now);
  } else {
    retryOrGiveUp("does not answer", now);
  }
}

void Session::retryOrGiveUp(const std::string& why, double now) {
  if (attempts_ < kAttempts) {
    send(now);
  } else if (in<ReadCamera>()) {
    checkFailed(nullptr, false, now);
  } else if (in<ReadFactory>()) {
    factory_.skip();  // images come without it
    answered(now);
  } else {
    throw SessionError(
        format("the Wii Remote %s report 0x%02x: take its batteries out and put them back",
               why.c_str(), request().id()));
  }
}

// ---- Reports of the remote

std::optional<protocol::DataReport> Session::handle(const Report& report, double now) {
  if (protocol::isDataReport(report.id()))
    return handleData(report, now);
  if (const auto acknowledgement = protocol::decodeAcknowledgement(report))
    handleAcknowledgement(*acknowledgement, now);
  else if (const auto packet = protocol::decodeMemoryPacket(report))
    handleMemory(*packet, now);
  else if (const auto status = protocol::decodeStatus(report))
    handleStatus(*status, now);
  return std::nullopt;
}

void Session::handleAcknowledgement(const protocol::Acknowledgement& acknowledgement, double now) {
  if (acknowledgement.report_id == protocol::kReportModeId)
    assembler_.modeAcknowledged(now);
  const std::uint8_t id = request().id();
  const std::uint8_t error = acknowledgement.error;
  if (in<Streaming>() || acknowledgement.report_id != id) {
    // Another program has switched the camera, or has written registers; where these are rewritten
    // instead of checked, it may be our own.
    if (error == 0 && registers_ != Registers::kUnreadable &&
        (acknowledgement.report_id == protocol::kIrClockId ||
         acknowledgement.report_id == protocol::kWriteMemoryId))
      doubtCamera(now);
    return;
  }
  // The answer to these is a report of its own.
  const bool only_errors = id == protocol::kStatusRequestId || id == protocol::kReadMemoryId;
  if (error == 0 && !only_errors)
    answered(now);
  else if (error == kErrorBusy && id == protocol::kReadMemoryId)
    answer_due_ = std::min(answer_due_, now + kFirstBusyPause * (1 << (attempts_ - 1)));
  else if (error != 0 && id == protocol::kWriteMemoryId)
    setUpCamera(now);  // the camera is off, or another program's write was refused
  else if (error != 0)
    retryOrGiveUp(
        "answers 'error " + std::to_string(error) + ", " + protocol::errorName(error) + "' to",
        now);
}

void Session::handleMemory(const protocol::MemoryPacket& packet, double now) {
  if (in<ReadFactory>()) {
    if (factory_.take(packet))
      answered(now);
  } else if (const auto* check = std::get_if<ReadCamera>(&state_)) {
    if (!camera_.answers(check->block, packet))
      return;
    if (const char* fault = camera_.fault(check->block, packet))
      checkFailed(fault, packet.error != 0, now);
    else
      answered(now);
  }
}

void Session::handleStatus(const protocol::Status& status, double now) {
  status_ = status;
  if (in<AskStatus>()) {
    answered(now);
  } else if (streaming_ && watch_.afterSilence(now) && showsPowerCycle(status)) {
    askAfterSilence(now);
  } else if (streaming_) {
    // Reporting stops at an unsolicited status, and the kernel's driver resets the mode after every
    // status.
    watch_.status(status.camera, now);
    if (in<Streaming>())
      enter(SetMode{}, now);
    else
      sendReportMode();
    if (status.leds != (options_.leds & 0x0f))
      transmit(protocol::setLeds(options_.leds));
  }
}

std::optional<protocol::DataReport> Session::handleData(const Report& report, double now) {
  const bool expected = assembler_.expects(report.id());
  mode_seen_ = mode_seen_ || expected;
  if (!streaming_)
    return std::nullopt;
  if (!expected) {
    handleOtherMode(report.id(), now);
    return std::nullopt;
  }
  const auto image = assembler_.add(report, now);
  if (!image)
    return std::nullopt;
  silences_ = 0;
  if (withholds(*image, now)) {
    watch_.alive(now);
    return std::nullopt;
  }
  if (watch_.image(*image, now) && fault_ == nullptr)
    noteFault(registers_ == Registers::kUnreadable ? "the camera was switched off"
                                                   : "the camera's logic was switched off");
  if (fault_ != nullptr && in<Streaming>())
    restored_ = std::exchange(fault_, nullptr);
  return image;
}

/// Whether the image may be of a camera that is stopped or in another format.
bool Session::withholds(const protocol::DataReport& image, double now) {
  if (!image.plausible && !withhold_ && now >= implausible_accepted_until_) {
    implausible_ = true;
    doubtCamera(now);
  }
  return withhold_ || in<WriteCamera>();
}

// Another program has changed the mode, and perhaps the camera as well.
void Session::handleOtherMode(std::uint8_t id, double now) {
  const bool due_to_status = id == protocol::kButtonsReportId && watch_.justAfterStatus(now);
  if (!in<Streaming>()) {  // the request under way ends with SetMode, or the check follows it
    if (!due_to_status)
      doubtCamera(now);
    return;
  }
  sendReportMode();
  if (due_to_status)
    return;
  withhold_ = true;
  noteFault("the report mode was changed");
  checkCamera({}, now);
}

}  // namespace wiimote_tracker::wiimote
