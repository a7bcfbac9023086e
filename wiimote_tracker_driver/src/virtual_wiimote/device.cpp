#include "wiimote_tracker_driver/virtual_wiimote/device.h"

#include "eeprom.h"
#include "ir_camera.h"
#include "nunchuk.h"

#include <algorithm>
#include <deque>

namespace wiimote_tracker::virtual_wiimote {
namespace {

// Output reports.
constexpr std::uint8_t kRumble = 0x10;
constexpr std::uint8_t kLeds = 0x11;
constexpr std::uint8_t kMode = 0x12;
constexpr std::uint8_t kIrClock = 0x13;
constexpr std::uint8_t kSpeaker = 0x14;
constexpr std::uint8_t kRequestStatus = 0x15;
constexpr std::uint8_t kWriteMemory = 0x16;
constexpr std::uint8_t kReadMemory = 0x17;
constexpr std::uint8_t kSpeakerMute = 0x19;
constexpr std::uint8_t kIrLogic = 0x1a;

// Bits of the second byte of output reports.
constexpr std::uint8_t kAcknowledge = 0x02;
constexpr std::uint8_t kOn = 0x04;
constexpr std::uint8_t kRegisters = 0x0c;  // 0x04 or 0x08

constexpr std::uint8_t kErrorBusy = 4;
constexpr std::uint8_t kErrorNoAnswer = 7;
constexpr std::uint8_t kErrorAddress = 8;

constexpr std::uint8_t kButtonMaskHigh = 0x1f;
constexpr std::uint8_t kButtonMaskLow = 0x9f;
constexpr std::uint8_t kBatteryLow = 0x20;

bool isCamera(std::uint32_t address) {
  return address >> 17 == 0xb0 >> 1;
}

/// What a data report carries after the buttons, in this order.
struct Layout {
  bool acceleration = false;
  std::size_t ir = 0;
  std::size_t extension = 0;
};

std::optional<Layout> layoutOf(std::uint8_t mode) {
  switch (mode) {
    case 0x30:
      return Layout{};
    case 0x31:
      return Layout{true, 0, 0};
    case 0x32:
      return Layout{false, 0, 8};
    case 0x33:
      return Layout{true, 12, 0};
    case 0x34:
      return Layout{false, 0, 19};
    case 0x35:
      return Layout{true, 0, 16};
    case 0x36:
      return Layout{false, 10, 9};
    case 0x37:
      return Layout{true, 10, 6};
    default:
      return std::nullopt;
  }
}

}  // namespace

struct Device::State {
  explicit State(const Options& device_options) : options(device_options) {}

  // Survives a change of batteries.
  Options options;
  Eeprom eeprom;
  bool nunchuk_plugged = false;

  // Does not.
  struct Volatile {
    IrCamera camera;
    Nunchuk nunchuk;
    Senses senses;
    std::uint8_t leds = 0;
    bool speaker = false;
    std::uint8_t mode = 0x30;
    bool continuous = false;
    bool reporting = true;  ///< Ends when a Nunchuk comes or goes, until the host sets a mode.
    Bytes last_data;
    std::deque<Bytes> memory_packets;  ///< Still to be sent of the read in progress.
  } now;

  Bytes withButtons(std::uint8_t id) const {
    return {id, static_cast<std::uint8_t>(now.senses.buttons >> 8 & kButtonMaskHigh),
            static_cast<std::uint8_t>(now.senses.buttons & kButtonMaskLow)};
  }

  Bytes acknowledgement(std::uint8_t id, std::uint8_t error) const {
    Bytes report = withButtons(0x22);
    report.push_back(id);
    report.push_back(error);
    return report;
  }

  Bytes status() const {
    Bytes report = withButtons(0x20);
    const bool low = options.battery < kBatteryLow;
    report.push_back(static_cast<std::uint8_t>(now.leds << 4 | (now.camera.onBus() ? 0x08 : 0) |
                                               (now.speaker ? 0x04 : 0) |
                                               (nunchuk_plugged ? 0x02 : 0) | (low ? 0x01 : 0)));
    report.insert(report.end(), {0, 0, options.battery});
    return report;
  }

  Bytes data() const {
    const Layout layout = *layoutOf(now.mode);
    Bytes report = withButtons(now.mode);
    if (layout.acceleration) {
      const std::array<int, 3> raw = Eeprom::convertAcceleration(now.senses.acceleration);
      for (const int value : raw)
        report.push_back(static_cast<std::uint8_t>(value >> 2));
      // The lowest bits travel in unused bits of the buttons; y and z have only nine bits.
      report[1] = static_cast<std::uint8_t>(report[1] | (raw[0] & 3) << 5);
      report[2] = static_cast<std::uint8_t>(report[2] | (raw[1] & 2) << 4 | (raw[2] & 2) << 5);
    }
    now.camera.appendData(layout.ir, report);
    if (nunchuk_plugged)
      now.nunchuk.appendData(layout.extension, report);
    else
      report.insert(report.end(), layout.extension, 0xff);
    return report;
  }

  /// Whether somebody answers at this address of the register space.
  bool onBus(std::uint32_t address) const {
    return (isCamera(address) && now.camera.onBus()) ||
           (Nunchuk::hasRegister(address) && nunchuk_plugged);
  }

  std::uint8_t readRegister(std::uint32_t address) const {
    return isCamera(address) ? now.camera.read(address) : now.nunchuk.read(address);
  }

  void writeRegister(std::uint32_t address, std::uint8_t value) {
    if (isCamera(address))
      now.camera.write(address, value);
    else
      now.nunchuk.write(address, value);
  }

  void setMode(const Bytes& in, std::vector<Bytes>& out) {
    if (in.size() < 3 || !layoutOf(in[2]))
      return;
    now.continuous = (in[1] & kOn) != 0;
    now.mode = in[2];
    now.reporting = true;
    if (in[1] & kAcknowledge)
      out.push_back(acknowledgement(kMode, 0));
    if (!now.memory_packets.empty())
      return;
    now.last_data = data();
    out.push_back(now.last_data);
  }

  void writeMemory(const Bytes& in, std::vector<Bytes>& out) {
    if (in.size() < 6 || in[5] == 0 || in[5] > 16)
      return;
    const std::size_t size = in[5];
    const std::uint32_t address = static_cast<std::uint32_t>(in[2] << 16 | in[3] << 8 | in[4]);
    Bytes payload(in.begin() + 6, in.end());
    payload.resize(16, 0);
    std::uint8_t error = 0;
    if (in[1] & kRegisters) {
      if (onBus(address)) {
        for (std::uint32_t i = 0; i < size; ++i)
          writeRegister(address + i, payload[i]);
      } else {
        error = kErrorNoAnswer;
      }
    } else if (Eeprom::contains(address, size)) {
      for (std::size_t i = 0; i < size; ++i)
        eeprom[address + i] = payload[i];
    } else {
      error = kErrorAddress;
    }
    out.push_back(acknowledgement(kWriteMemory, error));
  }

  void readMemory(const Bytes& in, std::vector<Bytes>& out) {
    if (in.size() < 7)
      return;
    if (!now.memory_packets.empty()) {
      out.push_back(acknowledgement(kReadMemory, kErrorBusy));
      return;
    }
    const std::uint32_t address = static_cast<std::uint32_t>(in[2] << 16 | in[3] << 8 | in[4]);
    const std::size_t size = static_cast<std::size_t>(in[5] << 8 | in[6]);
    const bool registers = (in[1] & kRegisters) != 0;
    std::uint8_t error = 0;
    if (registers && !onBus(address))
      error = kErrorNoAnswer;
    else if (!registers && !Eeprom::contains(address, size))
      error = kErrorAddress;
    if (error != 0) {
      out.push_back(memoryPacket(address, 16, error, Bytes(16, 0)));
      return;
    }
    for (std::size_t offset = 0; offset < size; offset += 16) {
      const std::size_t count = std::min<std::size_t>(16, size - offset);
      Bytes payload(16, 0);
      for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t at = address + static_cast<std::uint32_t>(offset + i);
        payload[i] = registers ? readRegister(at) : eeprom[at];
      }
      const std::uint32_t at = address + static_cast<std::uint32_t>(offset);
      now.memory_packets.push_back(memoryPacket(at, count, 0, payload));
    }
    // The first packet is sent at once, the others in place of the data reports that follow.
    if (!now.memory_packets.empty()) {
      out.push_back(now.memory_packets.front());
      now.memory_packets.pop_front();
    }
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
  switch (id) {
    case kMode:
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
  now.camera.look(senses.lights);
  if (!now.memory_packets.empty()) {
    Bytes packet = now.memory_packets.front();
    now.memory_packets.pop_front();
    return packet;
  }
  if (!now.reporting)
    return std::nullopt;
  Bytes data = state_->data();
  if (!now.continuous && data == now.last_data)
    return std::nullopt;
  now.last_data = data;
  return data;
}

std::uint8_t Device::leds() const {
  return state_->now.leds;
}

std::optional<Bytes> Device::setNunchuk(bool plugged) {
  if (plugged == state_->nunchuk_plugged)
    return std::nullopt;
  state_->nunchuk_plugged = plugged;
  state_->now.nunchuk = Nunchuk();
  state_->now.reporting = false;
  return state_->status();
}

void Device::powerCycle() {
  state_->now = State::Volatile();
}

}  // namespace wiimote_tracker::virtual_wiimote
