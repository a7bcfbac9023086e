#include "virtual_wiimote/faulty_device.h"

#include <algorithm>
#include <utility>

namespace wiimote_tracker::virtual_wiimote {
namespace {

constexpr std::size_t kLargestReport = 22;

bool isAnswer(const Bytes& report) {
  return report[0] >= 0x20 && report[0] <= 0x22;
}

}  // namespace

FaultyDevice::FaultyDevice(const Device::Options& options, const Faults& faults)
    : device_(options) {
  setFaults(faults);
}

void FaultyDevice::setFaults(const Faults& faults) {
  faults_ = faults;
  random_.seed(faults.seed);
  away_ = false;
  came_or_went_ = samples_;
  second_master_.reset();
  if (faults.second_master)
    second_master_ = SecondMaster();
}

bool FaultyDevice::chance(double probability) {
  return probability > 0.0 && random_() < probability * 4294967296.0;
}

/// A host's report reaches the device, which answers.
void FaultyDevice::deliver(const Bytes& report) {
  for (const Bytes& answer : device_.handleOutput(report))
    send(answer);
}

/// The device sends a report, which may get lost.
void FaultyDevice::send(Bytes report) {
  const bool answer = isAnswer(report);
  if (chance(answer ? faults_.lost_answers : faults_.lost_data))
    return;
  if (chance(faults_.truncated))
    report.resize(1 + below(report.size()));
  const int copies = chance(faults_.duplicated) ? 2 : 1;
  if (answer && chance(faults_.late_answers)) {
    const std::uint64_t due = samples_ + 1 + below(static_cast<std::size_t>(faults_.late_by));
    delayed_.insert(delayed_.end(), static_cast<std::size_t>(copies), {due, report});
    return;
  }
  for (int i = 0; i < copies; ++i)
    arrive(report);
}

/// A report reaches the host's end of the link; the second master receives it, too.
void FaultyDevice::arrive(const Bytes& report) {
  if (stalled()) {
    held_back_.push_back(report);
    return;
  }
  arrived_.push_back(report);
  if (!second_master_)
    return;
  for (const Bytes& request : second_master_->receive(report))
    deliver(request);
}

void FaultyDevice::releaseHeldBack() {
  // Replies of the second master come after all of these.
  for (const Bytes& report : std::exchange(held_back_, {}))
    arrive(report);
}

void FaultyDevice::releaseLate() {
  const auto due =
      std::stable_partition(delayed_.begin(), delayed_.end(),
                            [this](const DelayedReport& report) { return report.due > samples_; });
  const std::vector<DelayedReport> reports(due, delayed_.end());
  delayed_.erase(due, delayed_.end());
  for (const DelayedReport& report : reports)
    arrive(report.report);
}

/// A random report with an unknown id, or an answer with random contents.
Bytes FaultyDevice::garbage() {
  Bytes report(1 + below(kLargestReport));
  std::generate(report.begin(), report.end(),
                [this] { return static_cast<std::uint8_t>(random_()); });
  if (below(2) == 0)
    report[0] = static_cast<std::uint8_t>(0x20 + below(3));
  else
    report[0] = static_cast<std::uint8_t>(0x40 + below(0xc0));
  return report;
}

void FaultyDevice::goAwayOrComeBack() {
  const int stay = away_ ? faults_.unplug_for : faults_.unplug_every;
  if (faults_.unplug_every == 0 || samples_ - came_or_went_ < static_cast<std::uint64_t>(stay))
    return;
  const bool goes = !away_;
  powerCycle();
  away_ = goes;
}

void FaultyDevice::powerCycle() {
  device_.powerCycle();
  delayed_.clear();
  held_back_.clear();
  stall_end_ = 0;
  away_ = false;
  came_or_went_ = samples_;
  if (faults_.second_master)
    second_master_ = SecondMaster();
}

std::vector<Bytes> FaultyDevice::handleOutput(const Bytes& report) {
  if (!away_)
    deliver(report);
  return std::exchange(arrived_, {});
}

std::vector<Bytes> FaultyDevice::sample(const Senses& senses) {
  ++samples_;
  goAwayOrComeBack();
  if (away_)
    return {};
  if (!stalled()) {
    releaseHeldBack();
    if (chance(faults_.stalls))
      stall_end_ = samples_ + static_cast<std::uint64_t>(faults_.stall_length);
  }
  releaseLate();
  if (second_master_) {
    for (const Bytes& request : second_master_->tick())
      deliver(request);
  }
  if (chance(faults_.garbage))
    arrive(garbage());
  if (const std::optional<Bytes> report = device_.sample(senses))
    send(*report);
  return std::exchange(arrived_, {});
}

std::vector<Bytes> FaultyDevice::setNunchuk(bool plugged) {
  const std::optional<Bytes> status = device_.setNunchuk(plugged);
  if (status && !away_)
    send(*status);
  return std::exchange(arrived_, {});
}

}  // namespace wiimote_tracker::virtual_wiimote
