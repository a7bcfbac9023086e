#include "wiimote_tracker_driver/virtual_wiimote/device.h"

#include "data_report.h"
#include "eeprom.h"
#include "extension_port.h"
#include "ir_camera.h"

#include <algorithm>
#include <deque>
#include <utility>

namespace wiimote_tracker::virtual_wiimote {
namespace {

// Output reports.
constexpr std::uint8_t kRumble = 0x10;
constexpr std::uint8_t kLeds = 0x11;
constexpr std::uint8_t kReportMode = 0x12;
constexpr std::uint8_t kIrClock = 0x13;
constexpr std::uint8_t kSpeaker = 0x14;
constexpr std::uint8_t kRequestStatus = 0x15;
constexpr std::uint8_t kWriteMemory = 0x16;
constexpr std::uint8_t kReadMemory = 0x17;
constexpr std::uint8_t kSpeakerData = 0x18;
constexpr std::uint8_t kSpeakerMute = 0x19;
constexpr std::uint8_t kIrLogic = 0x1a;

// Bits of the second byte of output reports.
constexpr std::uint8_t kMotor = 0x01;
constexpr std::uint8_t kAcknowledge = 0x02;
constexpr std::uint8_t kOn = 0x04;

// Address spaces, by the same byte.
constexpr std::uint8_t kSpaceMask = 0x0c;
constexpr std::uint8_t kEepromSpace = 0x00;  // 0x04 and 0x08: registers
constexpr std::uint8_t kNoSpace = 0x0c;

constexpr std::uint8_t kErrorBusy = 4;
constexpr std::uint8_t kErrorSpace = 6;
constexpr std::uint8_t kErrorNoAnswer = 7;
constexpr std::uint8_t kErrorAddress = 8;

constexpr std::uint8_t kBatteryLow = 0x20;

/// Addresses that begin with b0 or b1.
bool isCamera(std::uint32_t address) {
  return address >> 17 == 0xb0 >> 1;
}

std::uint32_t addressOf(const Bytes& report) {
  return static_cast<std::uint32_t>(report[2] << 16 | report[3] << 8 | report[4]);
}

}  // namespace

struct Device::State {
  explicit State(const Options& device_options)
      : options(device_options), eeprom(options.factory_points), now(options) {}

  // Survives a change of batteries.
  Options options;
  Eeprom eeprom;

  // Lost with the batteries.
  struct Volatile {
    explicit Volatile(const Options& options)
        : camera(options.slot_seed), extension(options.motion_plus) {}

    IrCamera camera;
    ExtensionPort extension;
    Senses senses;
    std::uint8_t leds = 0;
    bool rumble = false;
    bool speaker = false;
    std::uint8_t mode = 0x30;
    bool continuous = false;
    bool reporting = true;  ///< Ends when an extension comes or goes, until the host sets a mode.
    std::optional<Sample> second_half;  ///< Pending second report of a sample.
    Bytes last_data;                    ///< The whole last sample.
    std::deque<Bytes> memory_packets;   ///< Pending packets of a read.
  } now;

  Bytes withButtons(std::uint8_t id) const { return beginReport(id, now.senses.buttons); }

  Bytes acknowledgement(std::uint8_t id, std::uint8_t error) const {
    Bytes report = withButtons(0x22);
    report.push_back(id);
    report.push_back(error);
    return report;
  }

  Bytes status() const {
    Bytes report = withButtons(0x20);
    const bool low = options.battery < kBatteryLow;
    report.push_back(static_cast<std::uint8_t>(
        now.leds << 4 | (now.camera.onBus() ? 0x08 : 0) | (now.speaker ? 0x04 : 0) |
        (now.extension.empty() ? 0 : 0x02) | (low ? 0x01 : 0)));
    report.insert(report.end(), {0, 0, options.battery});
    return report;
  }

  Sample takeSample() const {
    return {now.senses.buttons, Eeprom::convertAcceleration(now.senses.acceleration),
            now.camera.data(), now.extension.data()};
  }

  bool inHalves() const { return now.mode == kFirstHalf || now.mode == kSecondHalf; }

  /// The data report that is due; nothing if only changes are wanted and there is none.
  std::optional<Bytes> nextData(bool changes_only) {
    if (now.second_half) {
      now.second_half->buttons = now.senses.buttons;
      const Bytes second = dataReport(kSecondHalf, *now.second_half);
      now.second_half.reset();
      return second;
    }
    const Sample sample = takeSample();
    const Bytes report = dataReport(inHalves() ? kFirstHalf : now.mode, sample);
    Bytes data = report;
    if (inHalves()) {
      const Bytes second = dataReport(kSecondHalf, sample);
      data.insert(data.end(), second.begin(), second.end());
    }
    if (changes_only && data == now.last_data)
      return std::nullopt;
    now.last_data = std::move(data);
    if (inHalves())
      now.second_half = sample;
    return report;
  }

  /// Whether a device answers at this address of the register space.
  bool onBus(std::uint32_t address) const {
    return (isCamera(address) && now.camera.onBus()) || now.extension.hasRegister(address);
  }

  std::uint8_t readRegister(std::uint32_t address) const {
    return isCamera(address) ? now.camera.read(address) : now.extension.read(address);
  }

  void writeRegister(std::uint32_t address, std::uint8_t value) {
    if (isCamera(address))
      now.camera.write(address, value);
    else
      now.extension.write(address, value);
  }

  /// Error code for an access to this part of a space; 0: none.
  std::uint8_t addressError(std::uint8_t flags, std::uint32_t address, std::size_t size) const {
    const int space = flags & kSpaceMask;
    if (space == kNoSpace)
      return kErrorSpace;
    if (space == kEepromSpace)
      return Eeprom::contains(address, size) ? 0 : kErrorAddress;
    return onBus(address) ? 0 : kErrorNoAnswer;
  }

  void setMode(const Bytes& in, std::vector<Bytes>& out) {
    if (in.size() < 3 || !isDataReport(in[2]))
      return;
    now.rumble = (in[1] & kMotor) != 0;
    now.continuous = (in[1] & kOn) != 0;
    now.mode = in[2];
    now.reporting = true;
    now.second_half.reset();
    if (in[1] & kAcknowledge)
      out.push_back(acknowledgement(kReportMode, 0));
    if (now.memory_packets.empty())
      out.push_back(*nextData(false));
  }

  void writeMemory(const Bytes& in, std::vector<Bytes>& out) {
    if (in.size() < 6 || in[5] == 0 || in[5] > 16)
      return;
    const std::size_t size = in[5];
    const std::uint32_t address = addressOf(in);
    Bytes payload(in.begin() + 6, in.end());
    payload.resize(16, 0);
    const std::uint8_t error = addressError(in[1], address, size);
    const bool was_active = now.extension.motionPlusActive();
    for (std::uint32_t i = 0; i < size && error == 0; ++i) {
      if ((in[1] & kSpaceMask) == kEepromSpace)
        eeprom[address + i] = payload[i];
      else
        writeRegister(address + i, payload[i]);
    }
    out.push_back(acknowledgement(kWriteMemory, error));
    // To the host this looks like plugging or unplugging an extension.
    if (now.extension.motionPlusActive() != was_active)
      out.push_back(extensionChanged());
  }

  Bytes extensionChanged() {
    now.reporting = false;
    now.second_half.reset();
    return status();
  }

  void readMemory(const Bytes& in, std::vector<Bytes>& out) {
    if (in.size() < 7)
      return;
    const std::uint32_t address = addressOf(in);
    const std::size_t size = static_cast<std::size_t>(in[5] << 8 | in[6]);
    if (size == 0)
      return;
    if (!now.memory_packets.empty()) {
      out.push_back(acknowledgement(kReadMemory, kErrorBusy));
      return;
    }
    const std::uint8_t error = addressError(in[1], address, size);
    if (error != 0) {
      out.push_back(memoryPacket(address, 16, error, Bytes(16, 0)));
      return;
    }
    const bool from_eeprom = (in[1] & kSpaceMask) == kEepromSpace;
    for (std::size_t offset = 0; offset < size; offset += 16) {
      const std::size_t count = std::min<std::size_t>(16, size - offset);
      const std::uint32_t first = address + static_cast<std::uint32_t>(offset);
      Bytes payload(16, 0);
      for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t at = first + static_cast<std::uint32_t>(i);
        payload[i] = from_eeprom ? eeprom[at] : readRegister(at);
      }
      now.memory_packets.push_back(memoryPacket(first, count, 0, payload));
    }
    // The first packet is sent at once, the others replace the next data reports.
    out.push_back(now.memory_packets.front());
    now.memory_packets.pop_front();
  }

  Bytes memoryPacket(std::uint32_t address,
                     std::size_t count,
                     std::uint8_t error,
                     const Bytes& payload) const {
    Bytes report = withButtons(0x21);
    report.push_back(static_cast<std::uint8_t>((count - 1) << 4 | error));
    report.push_back(static_cast<std::uint8_t>(address >> 8));
    report.push_back(static_cast<std::uint8_t>(address));
    report.insert(report.end(), payload.begin(), payload.end());
    return report;
  }
};

Device::Device() : Device(Options()) {}

Device::Device(const Options& options) : state_(std::make_unique<State>(options)) {}

Device::~Device() = default;

std::vector<Bytes> Device::handleOutput(const Bytes& report) {
  std::vector<Bytes> answers;
  if (report.size() < 2)
    return answers;
  State& state = *state_;
  const std::uint8_t id = report[0];
  const std::uint8_t flags = report[1];
  // An invalid mode does not set the motor either.
  if (id >= kRumble && id <= kIrLogic && id != kReportMode)
    state.now.rumble = (flags & kMotor) != 0;
  switch (id) {
    case kReportMode:
      state.setMode(report, answers);
      return answers;
    case kWriteMemory:
      state.writeMemory(report, answers);
      return answers;
    case kReadMemory:
      state.readMemory(report, answers);
      return answers;
    case kRequestStatus:
      answers.push_back(state.status());
      return answers;
    case kLeds:
      state.now.leds = flags >> 4;
      break;
    case kIrClock:
      state.now.camera.setClock((flags & kOn) != 0);
      break;
    case kIrLogic:
      state.now.camera.setLogic((flags & kOn) != 0);
      break;
    case kSpeaker:
      state.now.speaker = (flags & kOn) != 0;
      break;
    case kSpeakerMute:
      break;
    case kRumble:  // never acknowledged
    case kSpeakerData:
    default:
      return answers;
  }
  if (flags & kAcknowledge)
    answers.push_back(state.acknowledgement(id, 0));
  return answers;
}

std::optional<Bytes> Device::sample(const Senses& senses) {
  State::Volatile& now = state_->now;
  now.senses = senses;
  now.camera.takeImage(senses.lights);
  if (!now.memory_packets.empty()) {
    Bytes packet = now.memory_packets.front();
    now.memory_packets.pop_front();
    return packet;
  }
  if (!now.reporting)
    return std::nullopt;
  return state_->nextData(!now.continuous);
}

std::uint8_t Device::leds() const {
  return state_->now.leds;
}

bool Device::rumble() const {
  return state_->now.rumble;
}

void Device::setBattery(std::uint8_t level) {
  state_->options.battery = level;
}

std::optional<Bytes> Device::setNunchuk(bool plugged) {
  if (plugged == state_->now.extension.nunchuk())
    return std::nullopt;
  state_->now.extension.setNunchuk(plugged);
  return state_->extensionChanged();
}

void Device::powerCycle() {
  const bool nunchuk = state_->now.extension.nunchuk();
  state_->now = State::Volatile(state_->options);
  state_->now.extension.setNunchuk(nunchuk);
}

}  // namespace wiimote_tracker::virtual_wiimote
