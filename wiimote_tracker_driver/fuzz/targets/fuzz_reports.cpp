#include "invariants.h"
#include "targets.h"

#include "wiimote_tracker_driver/protocol/input_reports.h"

namespace wiimote_tracker::fuzz {

using protocol::Report;

void fuzzReports(const std::uint8_t* data, std::size_t size) {
  const Report report(data, size);
  int meanings = 0;
  if (const auto image = protocol::decodeDataReport(report)) {
    ++meanings;
    requireInRange(*image);
  }
  if (const auto status = protocol::decodeStatus(report)) {
    ++meanings;
    require(status->leds <= 0x0f, "there are four LEDs");
    const double charge = protocol::batteryCharge(status->battery);
    require(charge >= 0.0 && charge <= 1.0, "a charge is from 0 to 1");
  }
  if (const auto packet = protocol::decodeMemoryPacket(report)) {
    ++meanings;
    require(packet->size <= packet->data.size(), "a packet holds its data");
    require((packet->size == 0) == (packet->error != 0), "a failed read has no data");
  }
  if (protocol::decodeAcknowledgement(report))
    ++meanings;
  require(meanings <= 1, "a report has one meaning");
  require((protocol::decodeButtons(report) & ~0x1f9f) == 0, "only buttons are in the buttons");

  const auto pair =
      protocol::decodeInterleaved(report, Report(data + report.size, size - report.size));
  if (pair)
    requireImage(*pair, protocol::IrFormat::kFull);

  // Some stacks pad reports: bytes after the meaningful ones change nothing.
  if (meanings == 1 && report.size < Report::kCapacity) {
    Report padded = report;
    padded.size = Report::kCapacity;
    const auto image = protocol::decodeDataReport(report);
    const auto padded_image = protocol::decodeDataReport(padded);
    require(image.has_value() == padded_image.has_value(), "padding keeps the meaning");
    require(!image || (image->id == padded_image->id && image->buttons == padded_image->buttons &&
                       image->acceleration == padded_image->acceleration),
            "padding keeps the content");
    require(protocol::decodeStatus(report) == protocol::decodeStatus(padded),
            "padding keeps the status");
  }
}

}  // namespace wiimote_tracker::fuzz
