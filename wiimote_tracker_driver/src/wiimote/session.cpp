#include "wiimote/session.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <utility>

namespace wiimote_tracker::wiimote {
namespace {

using protocol::Report;

constexpr std::uint8_t kErrorBusy = 4;
// Of a request, after which the remote is given up.
constexpr int kAttempts = 5;
// Pause before a read is repeated that the remote refused as busy [s]; doubles each time.
constexpr double kFirstBusyPause = 0.04;
// Camera set-ups, and silences of the stream, that may fail in a row.
constexpr int kMaximumFailures = 5;
// Camera set-ups after which registers that were never read count as unreadable.
constexpr int kReadAttempts = 3;

// A power cycle switches camera and LEDs off; other programs rarely change both.
bool showsPowerCycle(const protocol::Status& status, std::uint8_t leds) {
  const std::uint8_t ours = leds & 0x0f;
  return !status.camera && (ours == 0 || status.leds != ours);
}

}  // namespace

Session::Session(const Options& options, Output::Write write, double now)
    : options_(options),
      output_(std::move(write)),
      camera_(options.sensitivity, options.ir_format),
      assembler_(options.ir_format),
      watch_(options) {
  enter(kAskStatus, now);
}

// ---- The state diagram

// Of each state: the request, how often it is sent while no answer comes, the next state once it is
// answered, and what follows when no answer has come, and when the request is refused: kAttempts
// times, or once, if it writes registers.
Session::Row Session::row() const {
  using S = Session;
  using protocol::requestStatus;
  // Some remotes do not acknowledge all commands. That LEDs, clock and logic are on shows later.
  const int commands = acknowledges_ ? kAttempts : 1;
  const State written = registers_ == Registers::kUnreadable ? kSetMode : kReadCamera;
  switch (state_) {
    case kAskStatus:
      return {requestStatus(), kAttempts, kSetLeds, kGiveUp, kGiveUp};
    case kSetLeds:
      return {protocol::setLeds(options_.leds), commands, kReadFactory, &S::goOnUnacknowledged,
              kGiveUp};
    case kReadFactory:
      return {factory_.request(), kAttempts, factory_.complete() ? kStartClock : kReadFactory,
              &S::skipFactory, &S::skipFactory};
    case kStartClock:
      return {protocol::setIrClock(true), commands, kStartLogic, &S::goOnUnacknowledged, kGiveUp};
    case kStartLogic:
      return {protocol::setIrLogic(true), commands, kWriteCamera, &S::goOnUnacknowledged, kGiveUp};
    case kWriteCamera:
      return {camera_.write(block_), kAttempts, nextBlock(CameraConfiguration::kWrites, written),
              kGiveUp, &S::setUpCamera};
    case kReadCamera:
      return {camera_.read(block_), kAttempts, nextBlock(CameraConfiguration::kReads, kSetMode),
              &S::checkUnanswered, &S::checkUnanswered};
    case kSetMode:
      return {modeRequest(), mode_seen_ ? 1 : kAttempts, kStreaming,
              mode_seen_ ? &S::answered : kGiveUp, kGiveUp};
    case kStreaming:
      break;
    case kCheckBlock:
      return {camera_.read(block_), kAttempts, kStreaming, &S::checkUnanswered,
              &S::checkUnanswered};
    case kAskWhySilent:
      return {requestStatus(), kAttempts,
              showsPowerCycle(*status_, options_.leds) ? kSetLeds : kStartClock, kGiveUp, kGiveUp};
  }
  return {};
}

void Session::answered(double now) {
  const State next = row().next;
  if ((in(kReadCamera) || in(kCheckBlock)) && next != state_) {
    registers_ = Registers::kReadable;
    set_ups_ = 0;
    if (after_silence_)
      watch_.expectImage(now);
  } else if (in(kAskWhySilent) && next == kSetLeds) {
    fault_ = "the remote was switched off and on";
    restarted_ = true;
    factory_ = FactoryCalibration();
  }
  enter(next, now, next == state_ ? block_ + 1 : 0);
}

void Session::goOnUnacknowledged(double now) {
  acknowledges_ = false;
  answered(now);
}

void Session::skipFactory(double now) {
  factory_.skip();  // images come without it
  answered(now);
}

// The camera is off, a register differs, or another program's write was refused.
void Session::setUpCamera(double now) {
  if (++set_ups_ > kMaximumFailures)
    throw SessionError(
        "the camera of the Wii Remote cannot be set up: stop other programs that use the remote");
  streaming_ = false;
  watch_.settle();
  gate_ = ImageGate();
  enter(kStartClock, now);
}

// ---- Requests

void Session::enter(State state, double now, int block) {
  const bool camera_changed = std::exchange(camera_changed_, false);
  state_ = state;
  block_ = block;
  attempts_ = 0;
  mode_seen_ = false;
  after_silence_ = after_silence_ && inCamera();
  if (!in(kStreaming)) {
    send(now);
    return;
  }
  beginStreaming(now);
  if (camera_changed)
    enter(kWriteCamera, now);
}

void Session::send(double now) {
  ++attempts_;
  answer_due_ = now + options_.reply_timeout;
  output_.send(row().request);
}

void Session::repeat(int attempts, Action then, const std::string& why, double now) {
  if (attempts_ < attempts)
    send(now);
  else if (then != kGiveUp)
    (this->*then)(now);
  else
    throw SessionError(
        format("the Wii Remote %s report 0x%02x: take its batteries out and put them back",
               why.c_str(), row().request.id()));
}

double Session::deadline() const {
  return std::min(output_.deadline(), in(kStreaming) ? watch_.deadline() : answer_due_);
}

void Session::tick(double now) {
  output_.tick(now);
  if (in(kStreaming)) {
    keepStreaming(now);
  } else if (now >= answer_due_) {
    const Row row = this->row();
    repeat(row.attempts, row.silent, "does not answer", now);
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
  const std::uint8_t id = acknowledgement.report_id;
  const std::uint8_t error = acknowledgement.error;
  if (id == protocol::kReportModeId)
    assembler_.modeAcknowledged(now);
  const Row row = this->row();
  if (in(kStreaming) || id != row.request.id()) {
    // Another program has switched the camera, or has written registers; where these are rewritten
    // instead of checked, it may be our own.
    if (error == 0 && registers_ != Registers::kUnreadable &&
        (id == protocol::kIrClockId || id == protocol::kWriteMemoryId))
      doubtCamera(now);
    return;
  }
  // The answer to these is a report of its own.
  const bool only_errors = id == protocol::kStatusRequestId || id == protocol::kReadMemoryId;
  if (error == 0 && !only_errors)
    answered(now);
  else if (error == kErrorBusy && id == protocol::kReadMemoryId)
    answer_due_ = std::min(answer_due_, now + kFirstBusyPause * (1 << (attempts_ - 1)));
  else if (error != 0)
    repeat(id == protocol::kWriteMemoryId ? 1 : kAttempts, row.refused,
           "answers 'error " + std::to_string(error) + ", " + protocol::errorName(error) + "' to",
           now);
}

void Session::handleMemory(const protocol::MemoryPacket& packet, double now) {
  if (in(kReadFactory)) {
    if (factory_.take(packet))
      answered(now);
  } else if ((in(kReadCamera) || in(kCheckBlock)) && camera_.answers(block_, packet)) {
    if (const char* fault = camera_.fault(block_, packet))
      checkFailed(fault, packet.error != 0, now);  // an error: no camera answers in the remote
    else
      answered(now);
  }
}

void Session::handleStatus(const protocol::Status& status, double now) {
  status_ = status;
  if (in(kAskStatus) || in(kAskWhySilent)) {
    answered(now);
  } else if (streaming_ && watch_.afterSilence(now) && showsPowerCycle(status, options_.leds)) {
    askWhySilent(now);
  } else if (streaming_) {
    // Reporting stops at an unsolicited status, and the kernel's driver resets the mode after every
    // status.
    watch_.status(status.camera, now);
    if (in(kStreaming))
      enter(kSetMode, now);
    else
      output_.send(modeRequest());
    if (status.leds != (options_.leds & 0x0f))
      output_.send(protocol::setLeds(options_.leds));
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
  if (gate_.noteSuspicion(*image, now))
    doubtCamera(now);
  // While registers are written, an image may be of the old setting or of the new one.
  if (!gate_.open() || in(kWriteCamera)) {
    watch_.alive(now);
    return std::nullopt;
  }
  noteImage(*image, now);
  return image;
}

// An image of the camera as configured has come, so that what was to be restored is.
void Session::noteImage(const protocol::DataReport& image, double now) {
  const bool by_dark_check = watch_.image(image, now);
  if (by_dark_check && fault_ == nullptr)
    noteFault(registers_ == Registers::kUnreadable ? "the camera was switched off"
                                                   : "the camera's logic was switched off");
  if (fault_ != nullptr && in(kStreaming))
    restored_ = std::exchange(fault_, nullptr);
}

// Another program has changed the mode, and perhaps the camera as well.
void Session::handleOtherMode(std::uint8_t id, double now) {
  const bool due_to_status = id == protocol::kButtonsReportId && watch_.justAfterStatus(now);
  if (in(kStreaming))
    output_.send(modeRequest());
  if (due_to_status)
    return;
  if (!in(kStreaming)) {  // the request under way ends with kSetMode, or the check follows it
    doubtCamera(now);
    return;
  }
  gate_.close();
  noteFault("the report mode was changed");
  checkCamera(kReadCamera, 0, now);
}

// ---- Upkeep of the stream

void Session::beginStreaming(double now) {
  if (!streaming_)
    watch_.start(now);
  streaming_ = true;
  const bool readable = registers_ != Registers::kUnreadable;
  gate_.checked(readable, !watch_.doubted(), now);
  if (!readable)
    set_ups_ = 0;
}

void Session::keepStreaming(double now) {
  const StreamWatch::Upkeep due = watch_.take(now);
  if (due.images_stopped && watch_.silences() > kMaximumFailures)
    throw SessionError(
        "the Wii Remote answers but sends no images: take its batteries out and put them back");
  if (due.images_stopped)
    noteFault("the images stopped");
  if (due.ask_why_silent)
    askWhySilent(now);
  if (due.set_mode)
    output_.send(modeRequest());
  if (due.start_logic)
    output_.send(protocol::setIrLogic(true));
  if (due.ask_status)
    output_.send(protocol::requestStatus());
  after_silence_ = due.after_silence;
  if (due.check_block)
    checkCamera(kCheckBlock, *due.check_block, now);
  if (due.check_camera)
    checkCamera(kReadCamera, 0, now);
}

// Registers that cannot be read are written again: images are missing for five round trips.
void Session::checkCamera(State check, int block, double now) {
  if (registers_ == Registers::kUnreadable) {
    output_.send(protocol::setIrClock(true));
    output_.send(protocol::setIrLogic(true));
    enter(kWriteCamera, now);
  } else {
    enter(check, now, block);
  }
}

// `fault`: what a register shows; null when the read had no answer, or was refused.
void Session::checkFailed(const char* fault, bool camera_off, double now) {
  if (registers_ == Registers::kUnknown && set_ups_ + 1 >= kReadAttempts) {
    registers_ = Registers::kUnreadable;
    watch_.disableChecks();
    enter(kSetMode, now);
  } else if (streaming_ && (camera_off || fault == nullptr) &&
             (after_silence_ || watch_.silent(now))) {
    noteFault(camera_off ? fault : "the images stopped");
    askWhySilent(now);
  } else if (streaming_ && fault == nullptr) {
    enter(kSetMode, now);  // images come all the same
  } else {
    noteFault(fault);
    setUpCamera(now);
  }
}

void Session::doubtCamera(double now) {
  gate_.close();
  watch_.doubt(now);
}

void Session::askWhySilent(double now) {
  streaming_ = false;
  set_ups_ = 0;
  enter(kAskWhySilent, now);
}

void Session::noteFault(const char* fault) {
  if (streaming_)
    fault_ = fault;
}

// ---- What the user sets

void Session::setSensitivity(const protocol::IrSensitivity& sensitivity, double now) {
  camera_ = CameraConfiguration(sensitivity, options_.ir_format);
  if (in(kSetMode))
    camera_changed_ = true;
  else if (inCamera() || in(kStreaming))
    enter(kWriteCamera, now);
}

void Session::setLeds(std::uint8_t leds) {
  options_.leds = leds;
  output_.send(protocol::setLeds(leds));
}

void Session::switchOff() {
  output_.endRumble();
  output_.send(protocol::setReportMode(protocol::kButtonsReportId, false));
  output_.send(protocol::setIrClock(false));
  output_.send(protocol::setIrLogic(false));
  output_.send(protocol::setLeds(0));
}

}  // namespace wiimote_tracker::wiimote
