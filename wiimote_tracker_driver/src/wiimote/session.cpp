#include "wiimote_tracker_driver/wiimote/session.h"

#include "wiimote_tracker_driver/protocol/output_reports.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>

namespace wiimote_tracker::wiimote {
namespace {

using protocol::Report;
using protocol::Space;

constexpr std::uint8_t kImageReport = 0x33;
constexpr std::uint8_t kErrorBusy = 4;
// A read that found another one in progress is repeated after this [s].
constexpr double kBusyPause = 0.02;
// The interval of the checks in the dark doubles up to this [s].
constexpr double kLongestDarkCheck = 32.0;
// Set-ups of the camera, and watchdog restarts, that may fail in a row.
constexpr int kMaximumFailures = 5;
constexpr int kVerifyAttempts = 3;

template <std::size_t N>
Report writeRegisters(std::uint32_t address, const std::array<std::uint8_t, N>& data) {
  return protocol::writeMemory(Space::kRegisters, address, data.data(), data.size());
}

Report writeRegister(std::uint32_t address, std::uint8_t value) {
  return protocol::writeMemory(Space::kRegisters, address, &value, 1);
}

std::uint8_t mode(protocol::IrFormat format) {
  return static_cast<std::uint8_t>(format);
}

}  // namespace

Session::Session(const SessionOptions& options, Write write, double now)
    : options_(options), write_(std::move(write)) {
  enter(Step::kStatus, now);
}

Report Session::request() const {
  switch (step_) {
    case Step::kStatus:
      return protocol::requestStatus();
    case Step::kLeds:
      return protocol::setLeds(options_.leds);
    case Step::kAccelerometer:
      return protocol::readMemory(Space::kEeprom, protocol::kAccelerometerAddress,
                                  protocol::kAccelerometerBlockSize);
    case Step::kAccelerometerCopy:
      return protocol::readMemory(Space::kEeprom, protocol::kAccelerometerCopyAddress,
                                  protocol::kAccelerometerBlockSize);
    case Step::kIrClock:
      return protocol::setIrClock(true);
    case Step::kIrLogic:
      return protocol::setIrLogic(true);
    case Step::kIrSetup:
      return writeRegister(protocol::kIrControlRegister, protocol::kIrControlSetup);
    case Step::kIrBlock1:
      return writeRegisters(protocol::kIrBlock1Register, options_.sensitivity.block1);
    case Step::kIrBlock2:
      return writeRegisters(protocol::kIrBlock2Register, options_.sensitivity.block2);
    case Step::kIrMode:
      return writeRegister(protocol::kIrModeRegister, mode(protocol::IrFormat::kExtended));
    case Step::kIrRun:
      return writeRegister(protocol::kIrControlRegister, protocol::kIrControlRun);
    case Step::kIrVerify:
      return protocol::readMemory(Space::kRegisters, protocol::kIrControlRegister, 4);
    case Step::kReportMode:
    case Step::kStreaming:
      break;
  }
  return protocol::setReportMode(kImageReport, true);
}

void Session::enter(Step step, double now) {
  step_ = step;
  attempts_ = 0;
  if (step != Step::kStreaming) {
    send(now);
    return;
  }
  if (!images_valid_) {
    dark_check_interval_ = options_.dark_check;
    dark_check_due_ = now + dark_check_interval_;
    status_due_ = now + options_.status_interval;
  }
  images_valid_ = true;
  last_image_ = now;
}

void Session::next(double now) {
  switch (step_) {
    case Step::kAccelerometer:
      enter(Step::kIrClock, now);  // the copy is not needed
      break;
    case Step::kIrRun:
      enter(verifiable_ ? Step::kIrVerify : Step::kReportMode, now);
      break;
    default:
      enter(static_cast<Step>(static_cast<int>(step_) + 1), now);
  }
}

void Session::send(double now) {
  ++attempts_;
  answer_due_ = now + options_.reply_timeout;
  write_(request());
}

void Session::retry(const char* why, double now) {
  if (attempts_ < options_.attempts) {
    send(now);
  } else if (step_ == Step::kIrVerify) {
    verifyFailed(now);
  } else {
    char id[3];
    std::snprintf(id, sizeof(id), "%02x", static_cast<unsigned>(request().id()));
    throw SessionError("the Wii Remote " + std::string(why) + " report 0x" + id +
                       ": take its batteries out and put them back");
  }
}

void Session::setUpCamera(double now) {
  if (++camera_set_ups_ > kMaximumFailures)
    throw SessionError(
        "the camera of the Wii Remote cannot be set up: stop other programs that use the remote");
  images_valid_ = false;
  enter(Step::kIrClock, now);
}

void Session::checkCamera(double now) {
  if (verifiable_)
    enter(Step::kIrVerify, now);
  else
    setUpCamera(now);
}

// Either somebody has switched the camera off or changed it, or this remote does not let its
// registers be read. Only where reading has never worked is the latter believed.
void Session::verifyFailed(double now) {
  if (!verified_ && camera_set_ups_ + 1 >= kVerifyAttempts) {
    verifiable_ = false;
    enter(Step::kReportMode, now);
  } else if (after_silence_) {
    startOver(now);
  } else {
    setUpCamera(now);
  }
}

void Session::startOver(double now) {
  ++restarts_;
  after_silence_ = false;
  images_valid_ = false;
  camera_set_ups_ = 0;
  enter(Step::kStatus, now);
}

double Session::deadline() const {
  if (step_ != Step::kStreaming)
    return answer_due_;
  return std::min({last_image_ + options_.silence_timeout, dark_check_due_, status_due_});
}

void Session::tick(double now) {
  if (now < deadline())
    return;
  if (step_ != Step::kStreaming) {
    retry("does not answer", now);
  } else if (now >= last_image_ + options_.silence_timeout) {
    if (++silences_ > kMaximumFailures)
      throw SessionError(
          "the Wii Remote answers but sends no images: take its batteries out and "
          "put them back");
    if (silences_ == 1 && verifiable_) {
      // Perhaps only the mode was lost; if it was a power cycle, the camera is off as well.
      after_silence_ = true;
      write_(protocol::setReportMode(kImageReport, true));
      checkCamera(now);
    } else {
      startOver(now);
    }
  } else if (now >= dark_check_due_) {
    dark_check_interval_ = std::min(2.0 * dark_check_interval_, kLongestDarkCheck);
    dark_check_due_ = now + dark_check_interval_;
    // The one part of the set-up that cannot be read back; to say it again does no harm.
    write_(protocol::setIrLogic(true));
    checkCamera(now);
  } else {
    status_due_ = now + options_.status_interval;
    write_(protocol::requestStatus());
  }
}

std::optional<protocol::DataReport> Session::handle(const Report& report, double now) {
  if (const auto data = protocol::decodeDataReport(report))
    return handleData(*data, now);
  if (const auto acknowledgement = protocol::decodeAcknowledgement(report))
    handleAcknowledgement(*acknowledgement, now);
  else if (const auto packet = protocol::decodeMemoryPacket(report))
    handleMemory(*packet, now);
  else if (const auto status = protocol::decodeStatus(report))
    handleStatus(*status, now);
  return std::nullopt;
}

std::optional<protocol::DataReport> Session::handleData(const protocol::DataReport& data,
                                                        double now) {
  if (!images_valid_)
    return std::nullopt;
  if (data.id != kImageReport) {
    // Somebody has changed the mode, and perhaps the camera as well.
    if (step_ == Step::kStreaming) {
      write_(protocol::setReportMode(kImageReport, true));
      checkCamera(now);
    }
    return std::nullopt;
  }
  last_image_ = now;
  silences_ = 0;
  camera_set_ups_ = 0;
  const bool light = std::any_of(data.spots.begin(), data.spots.end(),
                                 [](const protocol::IrSpot& spot) { return spot.seen; });
  if (light) {
    dark_check_interval_ = options_.dark_check;
    dark_check_due_ = now + dark_check_interval_;
  }
  return data;
}

void Session::handleStatus(const protocol::Status& status, double now) {
  status_ = status;
  if (step_ == Step::kStatus) {
    next(now);
  } else if (step_ >= Step::kReportMode) {
    // Reporting stops at a status that nobody asked for, and the kernel's driver resets the mode
    // after every one.
    enter(Step::kReportMode, now);
  }
}

void Session::handleMemory(const protocol::MemoryPacket& packet, double now) {
  const bool first =
      step_ == Step::kAccelerometer && packet.address == protocol::kAccelerometerAddress;
  const bool copy =
      step_ == Step::kAccelerometerCopy && packet.address == protocol::kAccelerometerCopyAddress;
  if (first || copy) {
    std::array<std::uint8_t, protocol::kAccelerometerBlockSize> block{};
    std::copy_n(packet.data.begin(), block.size(), block.begin());
    accelerometer_ =
        packet.size == block.size() ? protocol::decodeAccelerometerBlock(block) : std::nullopt;
    if (first && !accelerometer_)
      enter(Step::kAccelerometerCopy, now);
    else
      next(now);
  } else if (step_ == Step::kIrVerify &&
             packet.address == (protocol::kIrControlRegister & 0xffff)) {
    const bool right = packet.size == 4 && packet.data[0] == protocol::kIrControlRun &&
                       packet.data[3] == mode(protocol::IrFormat::kExtended);
    if (right) {
      verified_ = true;
      after_silence_ = false;
      next(now);
    } else {
      verifyFailed(now);
    }
  }
}

void Session::handleAcknowledgement(const protocol::Acknowledgement& acknowledgement, double now) {
  if (step_ == Step::kStreaming || acknowledgement.report_id != request().id())
    return;
  const std::uint8_t error = acknowledgement.error;
  if (request().id() == protocol::kReadMemoryId) {
    if (error == kErrorBusy)
      answer_due_ = now + kBusyPause;
    else if (error != 0)
      retry("refuses", now);
  } else if (error == 0) {
    next(now);
  } else if (request().id() == protocol::kWriteMemoryId) {
    setUpCamera(now);  // the camera is off, or the answer was for somebody else's write
  } else {
    retry("refuses", now);
  }
}

void Session::switchOff() {
  write_(protocol::setReportMode(0x30, false));
  write_(protocol::setIrClock(false));
  write_(protocol::setIrLogic(false));
  write_(protocol::setLeds(0));
}

}  // namespace wiimote_tracker::wiimote
