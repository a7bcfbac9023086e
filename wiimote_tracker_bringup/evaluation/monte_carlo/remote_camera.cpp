#include "remote_camera.h"

#include "wiimote_tracker_driver/protocol/input_reports.h"
#include "wiimote_tracker_driver/protocol/output_reports.h"

#include <wiimote_tracker_msgs/text.h>

#include <array>
#include <stdexcept>

namespace wiimote_tracker::monte_carlo {
namespace {

using protocol::writeRegisters;

constexpr std::uint8_t kExtendedReport = 0x33;

}  // namespace

RemoteCamera::RemoteCamera(const std::string& sensitivity)
    : device_(std::make_unique<virtual_wiimote::Device>()) {
  const auto setting = protocol::irSensitivity(sensitivity);
  if (!setting)
    throw std::invalid_argument("there is no sensitivity '" + sensitivity + "': choose one of " +
                                joined(protocol::irSensitivityNames()));
  for (const protocol::Report& report :
       {protocol::setIrClock(true), protocol::setIrLogic(true),
        writeRegisters(protocol::kIrControlRegister, std::array{protocol::kIrControlSetup}),
        writeRegisters(protocol::kIrBlock1Register, setting->block1),
        writeRegisters(protocol::kIrBlock2Register, setting->block2),
        writeRegisters(protocol::kIrModeRegister,
                       std::array{static_cast<std::uint8_t>(protocol::IrFormat::kExtended)}),
        writeRegisters(protocol::kIrControlRegister, std::array{protocol::kIrControlRun}),
        protocol::setReportMode(kExtendedReport, true)})
    device_->handleOutput({report.begin(), report.end()});
}

const std::vector<tracking::Spot>& RemoteCamera::look(const virtual_wiimote::Senses& senses) {
  spots_.clear();
  const auto bytes = device_->sample(senses);
  const auto report =
      bytes ? protocol::decodeDataReport(protocol::Report(bytes->data(), bytes->size()))
            : std::nullopt;
  if (!report)
    throw std::logic_error("the virtual Wii Remote sends no images");
  for (std::size_t slot = 0; slot < report->spots.size(); ++slot) {
    const protocol::IrSpot& seen = report->spots[slot];
    if (!seen.seen)
      continue;
    tracking::Spot spot;
    spot.pixel = {seen.x, protocol::imageY(seen.y)};
    spot.slot = static_cast<int>(slot);
    spots_.push_back(spot);
  }
  return spots_;
}

}  // namespace wiimote_tracker::monte_carlo
