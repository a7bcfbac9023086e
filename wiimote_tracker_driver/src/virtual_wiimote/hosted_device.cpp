#include "wiimote_tracker_driver/virtual_wiimote/hosted_device.h"

#include "data_report.h"
#include "virtual_wiimote/faulty_device.h"

#include <algorithm>

namespace wiimote_tracker::virtual_wiimote {

HostedDevice::HostedDevice(const Device::Options& options, bool present)
    : device_(std::make_unique<FaultyDevice>(options)), present_(present) {}

HostedDevice::~HostedDevice() = default;

bool HostedDevice::sample(const Senses& senses) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!present_)
    return false;
  const std::vector<Bytes> reports = device_->sample(senses);
  setReachable(!device_->away());
  send(reports);
  return std::any_of(reports.begin(), reports.end(),
                     [](const Bytes& report) { return isDataReport(report.at(0)); });
}

void HostedDevice::setFaults(const Faults& faults) {
  const std::lock_guard<std::mutex> lock(mutex_);
  device_->setFaults(faults);
}

void HostedDevice::setNunchuk(bool plugged) {
  const std::lock_guard<std::mutex> lock(mutex_);
  send(device_->setNunchuk(plugged));
}

void HostedDevice::setBattery(std::uint8_t level) {
  const std::lock_guard<std::mutex> lock(mutex_);
  device_->device().setBattery(level);
}

std::uint8_t HostedDevice::leds() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return device_->device().leds();
}

bool HostedDevice::rumble() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return device_->device().rumble();
}

void HostedDevice::setPresent(bool present) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (present == present_)
    return;
  if (present)
    device_->powerCycle();
  setReachable(present);
  present_ = present;
}

}  // namespace wiimote_tracker::virtual_wiimote
