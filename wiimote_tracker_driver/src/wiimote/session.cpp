#include "wiimote/session.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace wiimote_tracker::wiimote {
namespace {

using protocol::Report;

constexpr std::uint8_t kErrorBusy = 4;
// Pause before a read is repeated that the remote refused as busy [s]; doubles each time.
constexpr double kBusyPause = 0.02;
// Camera set-ups, and silences of the stream, that may fail in a row.
constexpr int kMaximumFailures = 5;
// Camera set-ups after which registers that were never read count as unreadable.
constexpr int kReadAttempts = 3;
// How often a running motor is told to run [s].
constexpr double kRumbleInterval = 0.1;

constexpr std::uint8_t kButtonsReport = 0x30;

bool isDataReport(std::uint8_t id) {
  return id >= 0x30 && id <= 0x3f;
}

}  // namespace

Session::Session(const SessionOptions& options, Write write, double now)
    : options_(options),
      write_(std::move(write)),
      camera_(options.sensitivity, options.ir_format),
      assembler_(options.ir_format),
      watch_(options) {
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
  if (in<AskStatus>()) {
    enter(SetLeds{}, now);
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
  if (!in<Streaming>()) {
    send(now);
    return;
  }
  if (!streaming_)
    watch_.start(now);
  streaming_ = true;
  if (registers_ == Registers::kUnreadable)
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

void Session::retry(const std::string& why, double now) {
  if (attempts_ < options_.attempts) {
    send(now);
  } else if (in<ReadCamera>()) {
    checkFailed(nullptr, now);
  } else if (in<ReadFactory>()) {
    factory_.skip();  // images come without it
    answered(now);
  } else {
    char id[3];
    std::snprintf(id, sizeof(id), "%02x", static_cast<unsigned>(request().id()));
    throw SessionError("the Wii Remote " + why + " report 0x" + id +
                       ": take its batteries out and put them back");
  }
}

// ---- Reports of the remote

std::optional<protocol::DataReport> Session::handle(const Report& report, double now) {
  if (isDataReport(report.id()))
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
    duplicates_.modeAcknowledged(now);
  const std::uint8_t id = request().id();
  if (in<Streaming>() || acknowledgement.report_id != id)
    return;
  const std::uint8_t error = acknowledgement.error;
  if (error == kErrorBusy && id == protocol::kReadMemoryId)
    answer_due_ = std::min(answer_due_, now + kBusyPause * (1 << std::min(attempts_, 5)));
  else if (error == 0 && id != protocol::kReadMemoryId)
    answered(now);
  else if (error != 0 && id == protocol::kWriteMemoryId)
    setUpCamera(now);  // the camera is off, or another program's write was refused
  else if (error != 0)
    retry("answers 'error " + std::to_string(error) + ", " + protocol::errorName(error) + "' to",
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
      checkFailed(fault, now);
    else
      answered(now);
  }
}

void Session::handleStatus(const protocol::Status& status, double now) {
  status_ = status;
  if (in<AskStatus>()) {
    answered(now);
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
  if (!streaming_)
    return std::nullopt;
  if (!assembler_.expects(report.id())) {
    handleOtherMode(report.id(), now);
    return std::nullopt;
  }
  if (duplicates_.isDuplicate(report, now))
    return std::nullopt;
  const auto image = assembler_.add(report, now);
  if (!image)
    return std::nullopt;
  silences_ = 0;
  if (in<WriteCamera>()) {  // the camera is stopped
    watch_.alive(now);
    return std::nullopt;
  }
  if (watch_.image(*image, now) && fault_ == nullptr)
    noteFault("the camera's logic was switched off");
  if (fault_ != nullptr && in<Streaming>()) {
    ++restorations_;
    last_restoration_ = std::exchange(fault_, nullptr);
  }
  return image;
}

// Another program has changed the mode, and perhaps the camera as well.
void Session::handleOtherMode(std::uint8_t id, double now) {
  if (!in<Streaming>())
    return;  // the request under way ends with SetMode or another check
  sendReportMode();
  if (id == kButtonsReport && watch_.justAfterStatus(now))
    return;
  noteFault("the report mode was changed");
  checkCamera({}, now);
}

// ---- The camera

void Session::setUpCamera(double now) {
  if (++set_ups_ > kMaximumFailures)
    throw SessionError(
        "the camera of the Wii Remote cannot be set up: stop other programs that use the remote");
  streaming_ = false;
  enter(StartClock{}, now);
}

void Session::checkCamera(const ReadCamera& check, double now) {
  if (registers_ == Registers::kUnreadable)
    setUpCamera(now);
  else
    enter(check, now);
}

// `fault`: what a register shows; null when the read had no answer.
void Session::checkFailed(const char* fault, double now) {
  const bool after_silence = std::get<ReadCamera>(state_).after_silence;
  if (registers_ == Registers::kUnknown && set_ups_ + 1 >= kReadAttempts) {
    registers_ = Registers::kUnreadable;
    watch_.disableChecks();
    enter(SetMode{}, now);
  } else if (streaming_ && (after_silence || watch_.silent(now))) {
    startOver(now);
  } else if (streaming_ && fault == nullptr) {
    enter(SetMode{}, now);  // images come all the same
  } else {
    noteFault(fault);
    setUpCamera(now);
  }
}

void Session::setSensitivity(const protocol::IrSensitivity& sensitivity, double now) {
  camera_ = CameraConfiguration(sensitivity, options_.ir_format);
  if (auto* mode = std::get_if<SetMode>(&state_))
    mode->camera_changed = true;
  else if (const auto* check = std::get_if<ReadCamera>(&state_))
    enter(WriteCamera{0, check->after_silence}, now);
  else if (const auto* write = std::get_if<WriteCamera>(&state_))
    enter(WriteCamera{0, write->after_silence}, now);
  else if (in<Streaming>())
    enter(WriteCamera{}, now);
}

// ---- The stream

double Session::deadline() const {
  const double due = in<Streaming>() ? watch_.deadline() : answer_due_;
  return std::min(due, rumble_due_.value_or(due));
}

void Session::tick(double now) {
  if (rumble_due_ && now >= *rumble_due_)
    setRumble(true, now);
  if (in<Streaming>())
    keepStreaming(now);
  else if (now >= answer_due_)
    retry("does not answer", now);
}

void Session::keepStreaming(double now) {
  using Task = StreamWatch::Task;
  const auto readOne = [](int block, bool after_silence) {
    return ReadCamera{block, 1, false, after_silence};
  };
  switch (watch_.take(now)) {
    case Task::kNothing:
      break;
    case Task::kRestart:
      imagesStopped(now);
      break;
    case Task::kSetModeAndCheck:
      sendReportMode();
      checkCamera(readOne(0, true), now);
      break;
    case Task::kSetMode:
      sendReportMode();
      break;
    case Task::kCheckInDark:
      transmit(protocol::setIrLogic(true));  // cannot be read back, and may be repeated
      checkCamera({}, now);
      break;
    case Task::kCheckControl:
      checkCamera(readOne(0, false), now);
      break;
    case Task::kCheckNext:
      if (watch_.dark() && next_check_ == 0)
        transmit(protocol::setIrLogic(true));
      checkCamera(readOne(next_check_, false), now);
      next_check_ = (next_check_ + 1) % CameraConfiguration::kReads;
      break;
    case Task::kAskStatus:
      transmit(protocol::requestStatus());
      break;
  }
}

void Session::imagesStopped(double now) {
  if (++silences_ > kMaximumFailures)
    throw SessionError(
        "the Wii Remote answers but sends no images: take its batteries out and put them back");
  noteFault("the images stopped");
  if (silences_ > 1 || registers_ == Registers::kUnreadable) {
    startOver(now);
    return;
  }
  sendReportMode();
  checkCamera({0, CameraConfiguration::kReads, true, true}, now);
}

void Session::startOver(double now) {
  noteFault("the remote was switched off and on");
  ++restarts_;
  streaming_ = false;
  set_ups_ = 0;
  enter(AskStatus{}, now);
}

void Session::noteFault(const char* fault) {
  if (streaming_)
    fault_ = fault;
}

// ---- LEDs, motor, end

void Session::setLeds(std::uint8_t leds) {
  options_.leds = leds;
  transmit(protocol::setLeds(leds));
}

void Session::setRumble(bool rumble, double now) {
  rumble_due_ = rumble ? std::make_optional(now + kRumbleInterval) : std::nullopt;
  write_(protocol::setRumble(rumble));
}

void Session::switchOff() {
  rumble_due_.reset();
  transmit(protocol::setReportMode(kButtonsReport, false));
  transmit(protocol::setIrClock(false));
  transmit(protocol::setIrLogic(false));
  transmit(protocol::setLeds(0));
}

}  // namespace wiimote_tracker::wiimote
