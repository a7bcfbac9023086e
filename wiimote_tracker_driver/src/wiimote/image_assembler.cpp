#include "wiimote/image_assembler.h"

#include <stdexcept>
#include <utility>

namespace wiimote_tracker::wiimote {
namespace {

constexpr double kLatestRepetition = 0.0025;  // [s] After the acknowledgement.
constexpr double kShortestPeriod = 0.007;     // [s] Between two images.

std::uint8_t reportModeOf(protocol::IrFormat format) {
  switch (format) {
    case protocol::IrFormat::kBasic:
      return 0x37;  // 0x36 has no accelerometer
    case protocol::IrFormat::kExtended:
      return 0x33;
    case protocol::IrFormat::kFull:
      return protocol::kFirstHalfId;
    default:
      throw std::invalid_argument("an infrared format must be chosen");
  }
}

}  // namespace

ImageAssembler::ImageAssembler(protocol::IrFormat format) : mode_(reportModeOf(format)) {}

bool ImageAssembler::expects(std::uint8_t id) const {
  return id == mode_ || (mode_ == protocol::kFirstHalfId && id == protocol::kSecondHalfId);
}

/// A repeated report has the same bytes, or arrives early for a 10 ms period.
bool ImageAssembler::isRepeated(const protocol::Report& report, double now) {
  const auto acknowledged = std::exchange(acknowledged_, std::nullopt);
  if (acknowledged && now - *acknowledged < kLatestRepetition &&
      (report == last_ || now - last_arrival_ < kShortestPeriod))
    return true;
  last_ = report;
  last_arrival_ = now;
  return false;
}

std::optional<protocol::DataReport> ImageAssembler::add(const protocol::Report& report,
                                                        double now) {
  if (isRepeated(report, now))
    return std::nullopt;
  if (mode_ != protocol::kFirstHalfId)
    return report.id() == mode_ ? protocol::decodeDataReport(report) : std::nullopt;
  if (report.id() == protocol::kFirstHalfId) {
    first_ = report;
    first_arrival_ = now;
    return std::nullopt;
  }
  protocol::Report first;
  std::swap(first, first_);
  if (now - first_arrival_ > kLongestGap)
    return std::nullopt;
  return protocol::decodeInterleaved(first, report);
}

}  // namespace wiimote_tracker::wiimote
