#include "recorded_remote.h"

#include "wiimote_tracker_driver/protocol/ir_camera.h"
#include "wiimote_tracker_driver/protocol/output_reports.h"

#include <algorithm>

namespace wiimote_tracker::recording {
namespace {

using protocol::Report;

constexpr std::size_t kPacketSize = 16;
constexpr std::uint8_t kRegisters = static_cast<std::uint8_t>(protocol::Space::kRegisters);
// The camera's two sensitivity blocks and its format; keys of Memory.
constexpr std::uint32_t kBlock1 = kRegisters << 24 | protocol::kIrBlock1Register;
constexpr std::uint32_t kBlock2 = kRegisters << 24 | protocol::kIrBlock2Register;
constexpr std::uint32_t kFormat = kRegisters << 24 | protocol::kIrModeRegister;

/// The flags without the state of the motor, which every report carries.
std::uint8_t flags(const Report& report) {
  return report.bytes[1] & ~protocol::kRumbleBit;
}

/// Address of a request to read or write memory.
std::uint32_t address(const Report& report) {
  const auto& b = report.bytes;
  return static_cast<std::uint32_t>((b[1] & kRegisters) << 24 | b[2] << 16 | b[3] << 8 | b[4]);
}

std::size_t sizeToRead(const Report& request) {
  return static_cast<std::size_t>(request.bytes[5] << 8 | request.bytes[6]);
}

/// Address of a packet that answers `request`; nothing if it answers another one.
std::optional<std::uint32_t> placeOf(const protocol::MemoryPacket& packet, const Report& request) {
  if (request.id() != protocol::kReadMemoryId)
    return std::nullopt;
  const std::uint32_t begin = address(request);
  // The packet holds only the lower 16 bits of its address.
  const std::uint32_t offset = (packet.address - begin) & 0xffff;
  if (offset + packet.size > sizeToRead(request))
    return std::nullopt;
  return begin + offset;
}

template <typename Memory>
void store(const Report& write, Memory& memory) {
  const std::size_t size = std::min<std::size_t>(write.bytes[5], kPacketSize);
  for (std::size_t i = 0; i < size; ++i)
    memory[address(write) + static_cast<std::uint32_t>(i)] = write.bytes[6 + i];
}

Report acknowledgement(std::uint8_t id) {
  return {0x22, 0, 0, id, 0};
}

}  // namespace

bool sameRequest(const Report& a, const Report& b) {
  if (a.id() != b.id())
    return false;
  switch (a.id()) {
    case protocol::kWriteMemoryId:
      return address(a) == address(b) && a.bytes[5] == b.bytes[5];
    case protocol::kReadMemoryId:
      return address(a) == address(b) && sizeToRead(a) == sizeToRead(b);
    case protocol::kLedsId:
    case protocol::kReportModeId:
      return true;
    default:
      return flags(a) == flags(b);
  }
}

void RecordedRemote::learn(const Record& record) {
  const Report& report = record.report;
  if (record.kind == Record::Kind::kSent) {
    if (report.id() == protocol::kReadMemoryId)
      recorded_read_ = report;
    else if (report.id() == protocol::kWriteMemoryId)
      store(report, settings_);
  } else if (record.kind == Record::Kind::kReceived) {
    ++received_[report.id()];
    if (protocol::decodeStatus(report))
      status_ = report;
    learnMemory(report);
  }
}

void RecordedRemote::learnMemory(const Report& report) {
  const auto packet = protocol::decodeMemoryPacket(report);
  if (!packet || packet->error != 0)
    return;
  if (const auto place = placeOf(*packet, recorded_read_)) {
    for (std::size_t i = 0; i < packet->size; ++i)
      memory_[*place + static_cast<std::uint32_t>(i)] = packet->data[i];
  }
}

void RecordedRemote::recordedHostSent(const Report& report) {
  if (report.id() == protocol::kWriteMemoryId)
    store(report, recorded_values_);
}

void RecordedRemote::hostSends(const Report& report) {
  if (report.id() == protocol::kReadMemoryId) {
    own_read_ = report;
  } else if (report.id() == protocol::kWriteMemoryId) {
    store(report, own_values_);
    store(report, memory_);
  }
}

void RecordedRemote::answer(const Report& request, std::deque<Report>& answers) const {
  constexpr std::uint8_t kWantsAcknowledgement = 0x02;
  switch (request.id()) {
    case protocol::kStatusRequestId:
      answers.push_back(status_.value_or(Report{0x20, 0, 0, 0, 0, 0, 0}));
      break;
    case protocol::kReadMemoryId:
      answerRead(request, answers);
      break;
    case protocol::kWriteMemoryId:
      answers.push_back(acknowledgement(request.id()));
      break;
    default:
      if ((request.bytes[1] & kWantsAcknowledgement) != 0)
        answers.push_back(acknowledgement(request.id()));
  }
}

void RecordedRemote::answerRead(const Report& request, std::deque<Report>& answers) const {
  constexpr std::uint8_t kNoSuchMemory = 8;
  const std::uint32_t begin = address(request);
  const std::size_t size = sizeToRead(request);
  for (std::size_t done = 0; done < size; done += kPacketSize) {
    const std::size_t packet_size = std::min(kPacketSize, size - done);
    const std::uint32_t place = begin + static_cast<std::uint32_t>(done);
    Report packet{0x21,
                  0,
                  0,
                  static_cast<std::uint8_t>((packet_size - 1) << 4),
                  static_cast<std::uint8_t>(place >> 8),
                  static_cast<std::uint8_t>(place)};
    packet.size = Report::kCapacity;
    for (std::size_t i = 0; i < packet_size; ++i) {
      const std::uint32_t key = place + static_cast<std::uint32_t>(i);
      const auto value = memory_.find(key);
      if (value == memory_.end()) {
        packet.bytes[3] = 0xf0 | kNoSuchMemory;
        std::fill(packet.bytes.begin() + 6, packet.bytes.end(), std::uint8_t{0});
        answers.push_back(packet);
        return;
      }
      packet.bytes[6 + i] = value->second;
    }
    answers.push_back(packet);
  }
}

void RecordedRemote::putOwnValuesInto(Report& report) const {
  const auto packet = protocol::decodeMemoryPacket(report);
  if (!packet || packet->error != 0)
    return;
  const auto place = placeOf(*packet, own_read_);
  if (!place)
    return;
  for (std::size_t i = 0; i < packet->size; ++i) {
    const std::uint32_t key = *place + static_cast<std::uint32_t>(i);
    const auto recorded = recorded_values_.find(key);
    const auto own = own_values_.find(key);
    if (recorded != recorded_values_.end() && own != own_values_.end() &&
        recorded->second == packet->data[i])
      report.bytes[6 + i] = own->second;
  }
}

std::optional<protocol::IrFormat> RecordedRemote::irFormat() const {
  const std::uint64_t basic = received_[0x36] + received_[0x37];
  const std::uint64_t extended = received_[0x33];
  const std::uint64_t full = received_[protocol::kFirstHalfId] + received_[protocol::kSecondHalfId];
  const std::uint64_t most = std::max({basic, extended, full});
  if (most == 0)
    return std::nullopt;
  if (most == extended)
    return protocol::IrFormat::kExtended;
  return most == full ? protocol::IrFormat::kFull : protocol::IrFormat::kBasic;
}

bool RecordedRemote::differs(std::uint32_t first, std::uint32_t last) const {
  return std::any_of(own_values_.lower_bound(first), own_values_.upper_bound(last),
                     [this](const Memory::value_type& own) {
                       const auto recorded = settings_.find(own.first);
                       return recorded != settings_.end() && recorded->second != own.second;
                     });
}

bool RecordedRemote::sensitivityDiffers() const {
  return differs(kBlock1, kBlock1 + 8) || differs(kBlock2, kBlock2 + 1);
}

bool RecordedRemote::formatDiffers() const {
  return differs(kFormat, kFormat);
}

}  // namespace wiimote_tracker::recording
