#include "wiimote_tracker_driver/wiimote/session.h"

#include <algorithm>
#include <cstdio>
#include <utility>

namespace wiimote_tracker::wiimote {
namespace {

using protocol::Report;

constexpr std::uint8_t kErrorBusy = 4;
// A read that found another one in progress is repeated after this, doubled each time [s].
constexpr double kBusyPause = 0.02;
// Set-ups of the camera, and watchdog restarts, that may fail in a row.
constexpr int kMaximumFailures = 5;
constexpr int kVerifyAttempts = 3;
// While the motor is to run it is told so this often [s].
constexpr double kRumbleInterval = 0.1;

// A remote may say its present data once more right after it has acknowledged a mode (the virtual
// one does): no later than kEcho, two turns of the radio [s]. That is no image of its own, and
// would mislead whoever learns the camera's rhythm. It is told by the same bytes, or by coming
// sooner after the report before than the rhythm of 10 ms has it [s].
constexpr double kEcho = 0.0025;
constexpr double kTooSoon = 0.007;

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
  enter(Step::kStatus, now);
}

// ---- Requests

Report Session::request() const {
  switch (step_) {
    case Step::kStatus:
      return protocol::requestStatus();
    case Step::kLeds:
      return protocol::setLeds(options_.leds);
    case Step::kFactory:
      return factory_.request();
    case Step::kIrClock:
      return protocol::setIrClock(true);
    case Step::kIrLogic:
      return protocol::setIrLogic(true);
    case Step::kCameraWrite:
      return camera_.write(index_);
    case Step::kCameraRead:
      return camera_.read(index_);
    case Step::kReportMode:
    case Step::kStreaming:
      break;
  }
  return protocol::setReportMode(assembler_.reportMode(), true);
}

void Session::transmit(Report report) {
  if (rumble_)
    report.bytes[1] |= protocol::kRumbleBit;
  write_(report);
}

void Session::enter(Step step, double now) {
  step_ = step;
  attempts_ = 0;
  if (step != Step::kStreaming) {
    send(now);
    return;
  }
  if (!images_valid_) {
    images_valid_ = true;
    watch_.start(now);
  }
  if (!verifiable_)
    set_ups_ = 0;
  if (write_pending_)
    writeCamera(now);
}

void Session::next(double now) {
  if (step_ == Step::kLeds) {
    factory_ = FactoryCalibration();
    enter(Step::kFactory, now);
  } else if (step_ == Step::kIrLogic) {
    writeCamera(now);
  } else if (step_ != Step::kCameraWrite) {
    enter(static_cast<Step>(static_cast<int>(step_) + 1), now);
  } else if (++index_ < CameraConfiguration::kWrites) {
    enter(Step::kCameraWrite, now);
  } else if (verifiable_) {
    checkCamera(0, CameraConfiguration::kReads, now);
  } else {
    enter(Step::kReportMode, now);
  }
}

void Session::send(double now) {
  ++attempts_;
  answer_due_ = now + options_.reply_timeout;
  transmit(request());
}

void Session::retry(const std::string& why, double now) {
  if (attempts_ < options_.attempts) {
    send(now);
  } else if (step_ == Step::kCameraRead) {
    checkFailed(nullptr, now);
  } else if (step_ == Step::kFactory) {
    // Good to know, but images come without it.
    factory_.skip();
    enter(factory_.complete() ? Step::kIrClock : Step::kFactory, now);
  } else {
    char id[3];
    std::snprintf(id, sizeof(id), "%02x", static_cast<unsigned>(request().id()));
    throw SessionError("the Wii Remote " + why + " report 0x" + id +
                       ": take its batteries out and put them back");
  }
}

// ---- Answers

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
    mode_acknowledged_ = now;
  const std::uint8_t id = request().id();
  if (step_ == Step::kStreaming || acknowledgement.report_id != id)
    return;
  const std::uint8_t error = acknowledgement.error;
  if (error == kErrorBusy && id == protocol::kReadMemoryId)
    answer_due_ = std::min(answer_due_, now + kBusyPause * (1 << std::min(attempts_, 5)));
  else if (error == 0 && id != protocol::kReadMemoryId)
    next(now);
  else if (error != 0 && id == protocol::kWriteMemoryId)
    setUpCamera(now);  // the camera is off, or the answer was for somebody else's write
  else if (error != 0)
    retry("answers 'error " + std::to_string(error) + ", " + protocol::errorName(error) + "' to",
          now);
}

void Session::handleMemory(const protocol::MemoryPacket& packet, double now) {
  if (step_ == Step::kFactory) {
    if (factory_.take(packet))
      enter(factory_.complete() ? Step::kIrClock : Step::kFactory, now);
  } else if (step_ == Step::kCameraRead && camera_.answers(index_, packet)) {
    if (const char* fault = camera_.fault(index_, packet))
      checkFailed(fault, now);
    else
      checkPassed(now);
  }
}

void Session::handleStatus(const protocol::Status& status, double now) {
  status_ = status;
  if (step_ == Step::kStatus) {
    next(now);
  } else if (images_valid_) {
    // Reporting stops at a status that nobody asked for, and the kernel's driver resets the mode
    // after every one.
    watch_.status(status.camera, now);
    if (step_ == Step::kStreaming)
      enter(Step::kReportMode, now);
    else
      setReportMode();
    if (status.leds != (options_.leds & 0x0f))
      transmit(protocol::setLeds(options_.leds));
  }
}

std::optional<protocol::DataReport> Session::handleData(const Report& report, double now) {
  if (!images_valid_)
    return std::nullopt;
  if (!assembler_.expects(report.id())) {
    otherReport(report.id(), now);
    return std::nullopt;
  }
  if (isEcho(report, now))
    return std::nullopt;
  const auto image = assembler_.add(report, now);
  if (!image)
    return std::nullopt;
  silences_ = 0;
  if (step_ == Step::kCameraWrite) {  // the camera is stopped
    watch_.alive(now);
    return std::nullopt;
  }
  if (watch_.image(*image, now) && found_ == nullptr)
    found("the camera's logic was switched off");
  if (found_ != nullptr && step_ == Step::kStreaming) {
    ++restorations_;
    last_restoration_ = found_;
    found_ = nullptr;
  }
  return image;
}

bool Session::isEcho(const Report& report, double now) {
  const auto acknowledged = std::exchange(mode_acknowledged_, std::nullopt);
  if (acknowledged && now - *acknowledged < kEcho &&
      (report == last_data_ || now - last_data_at_ < kTooSoon))
    return true;
  last_data_ = report;
  last_data_at_ = now;
  return false;
}

// Somebody has changed the mode, and perhaps the camera as well.
void Session::otherReport(std::uint8_t id, double now) {
  if (step_ != Step::kStreaming)
    return;  // what is under way ends with a look at all that
  setReportMode();
  if (id == kButtonsReport && watch_.justAfterStatus(now))
    return;
  found("the report mode was changed");
  checkCamera(0, CameraConfiguration::kReads, now);
}

// ---- The camera

void Session::setUpCamera(double now) {
  if (++set_ups_ > kMaximumFailures)
    throw SessionError(
        "the camera of the Wii Remote cannot be set up: stop other programs that use the remote");
  images_valid_ = false;
  enter(Step::kIrClock, now);
}

void Session::writeCamera(double now) {
  write_pending_ = false;
  index_ = 0;
  enter(Step::kCameraWrite, now);
}

void Session::checkCamera(int first, int reads, double now) {
  if (!verifiable_) {
    setUpCamera(now);
    return;
  }
  index_ = first;
  reads_left_ = reads;
  after_check_ = reads == 1 ? Step::kStreaming : Step::kReportMode;
  enter(Step::kCameraRead, now);
}

void Session::checkPassed(double now) {
  index_ = (index_ + 1) % CameraConfiguration::kReads;
  if (--reads_left_ > 0) {
    enter(Step::kCameraRead, now);
    return;
  }
  verified_ = true;
  set_ups_ = 0;
  if (after_silence_) {
    after_silence_ = false;
    watch_.expectImage(now);
  }
  enter(after_check_, now);
}

// Either somebody has switched the camera off or changed it (`fault` says what), or nobody answers
// (null): perhaps this remote does not let its registers be read. That is believed only where
// reading has never worked.
void Session::checkFailed(const char* fault, double now) {
  if (!verified_ && set_ups_ + 1 >= kVerifyAttempts) {
    verifiable_ = false;
    watch_.disableChecks();
    enter(Step::kReportMode, now);
  } else if (images_valid_ && (after_silence_ || watch_.silent(now))) {
    startOver(now);
  } else if (images_valid_ && fault == nullptr) {
    enter(Step::kReportMode, now);  // images come all the same
  } else {
    found(fault);
    setUpCamera(now);
  }
}

void Session::setSensitivity(const protocol::IrSensitivity& sensitivity, double now) {
  camera_ = CameraConfiguration(sensitivity, options_.ir_format);
  if (step_ == Step::kCameraWrite || step_ == Step::kCameraRead || step_ == Step::kStreaming)
    writeCamera(now);
  else
    write_pending_ = step_ == Step::kReportMode;
}

// ---- The stream

double Session::deadline() const {
  const double due = step_ == Step::kStreaming ? watch_.deadline() : answer_due_;
  return rumble_ ? std::min(due, rumble_due_) : due;
}

void Session::tick(double now) {
  if (rumble_ && now >= rumble_due_)
    setRumble(true, now);
  if (step_ == Step::kStreaming)
    keepStreaming(now);
  else if (now >= answer_due_)
    retry("does not answer", now);
}

void Session::keepStreaming(double now) {
  using Task = StreamWatch::Task;
  switch (watch_.take(now)) {
    case Task::kNothing:
      break;
    case Task::kRestart:
      imagesStopped(now);
      break;
    case Task::kRemind:
      // If it was not the mode but a power cycle, the camera is off as well.
      setReportMode();
      after_silence_ = true;
      checkCamera(0, 1, now);
      break;
    case Task::kRepeatMode:
      setReportMode();
      break;
    case Task::kCheckInDark:
      // 0x1a cannot be read back; to say it again does no harm.
      transmit(protocol::setIrLogic(true));
      checkCamera(0, CameraConfiguration::kReads, now);
      break;
    case Task::kCheckControl:
      checkCamera(0, 1, now);
      break;
    case Task::kCheckNext:
      if (watch_.dark() && next_check_ == 0)
        transmit(protocol::setIrLogic(true));
      checkCamera(next_check_, 1, now);
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
  found("the images stopped");
  if (silences_ == 1 && verifiable_) {
    setReportMode();
    after_silence_ = true;
    checkCamera(0, CameraConfiguration::kReads, now);
  } else {
    startOver(now);
  }
}

void Session::startOver(double now) {
  found("the remote was switched off and on");
  ++restarts_;
  after_silence_ = false;
  images_valid_ = false;
  set_ups_ = 0;
  enter(Step::kStatus, now);
}

void Session::found(const char* what) {
  if (images_valid_)
    found_ = what;
}

// ---- LEDs, motor, farewell

void Session::setLeds(std::uint8_t leds) {
  options_.leds = leds;
  transmit(protocol::setLeds(leds));
}

void Session::setRumble(bool rumble, double now) {
  rumble_ = rumble;
  rumble_due_ = now + kRumbleInterval;
  write_(protocol::setRumble(rumble));
}

void Session::switchOff() {
  rumble_ = false;
  transmit(protocol::setReportMode(kButtonsReport, false));
  transmit(protocol::setIrClock(false));
  transmit(protocol::setIrLogic(false));
  transmit(protocol::setLeds(0));
}

}  // namespace wiimote_tracker::wiimote
