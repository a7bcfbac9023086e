// Session: keeps camera, images, LEDs and motor as they should be.
#include "wiimote/session.h"

#include <algorithm>

namespace wiimote_tracker::wiimote {
namespace {

// Camera set-ups, and silences of the stream, that may fail in a row.
constexpr int kMaximumFailures = 5;
// Camera set-ups after which registers that were never read count as unreadable.
constexpr int kReadAttempts = 3;
// How often a running motor is told to run [s].
constexpr double kRumbleInterval = 0.1;

}  // namespace

// ---- The camera

void Session::setUpCamera(double now) {
  if (++set_ups_ > kMaximumFailures)
    throw SessionError(
        "the camera of the Wii Remote cannot be set up: stop other programs that use the remote");
  streaming_ = false;
  watch_.settle();
  implausible_ = false;
  implausible_accepted_until_ = now;
  enter(StartClock{}, now);
}

// Registers that cannot be read are written again: images are missing for five round trips.
void Session::checkCamera(const ReadCamera& check, double now) {
  if (registers_ == Registers::kUnreadable) {
    transmit(protocol::setIrClock(true));
    transmit(protocol::setIrLogic(true));
    enter(WriteCamera{}, now);
  } else {
    enter(check, now);
  }
}

void Session::doubtCamera(double now) {
  withhold_ = true;
  watch_.doubt(now);
}

// `fault`: what a register shows; null when the read had no answer.
void Session::checkFailed(const char* fault, bool camera_off, double now) {
  const bool after_silence = std::get<ReadCamera>(state_).after_silence;
  if (registers_ == Registers::kUnknown && set_ups_ + 1 >= kReadAttempts) {
    registers_ = Registers::kUnreadable;
    watch_.disableChecks();
    enter(SetMode{}, now);
  } else if (streaming_ && (camera_off || fault == nullptr) &&
             (after_silence || watch_.silent(now))) {
    noteFault(camera_off ? fault : "the images stopped");
    askAfterSilence(now);
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
    unanswered(now);
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
      if (registers_ == Registers::kUnreadable)
        transmit(protocol::requestStatus());
      else
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
    askAfterSilence(now);
    return;
  }
  sendReportMode();
  checkCamera({0, CameraConfiguration::kReads, true, true}, now);
}

void Session::askAfterSilence(double now) {
  streaming_ = false;
  set_ups_ = 0;
  enter(AskStatus{true}, now);
}

// A power cycle switches camera and LEDs off; other programs rarely change both.
bool Session::showsPowerCycle(const protocol::Status& status) const {
  const std::uint8_t ours = options_.leds & 0x0f;
  return !status.camera && (ours == 0 || status.leds != ours);
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
  transmit(protocol::setReportMode(protocol::kButtonsReportId, false));
  transmit(protocol::setIrClock(false));
  transmit(protocol::setIrLogic(false));
  transmit(protocol::setLeds(0));
}

}  // namespace wiimote_tracker::wiimote
