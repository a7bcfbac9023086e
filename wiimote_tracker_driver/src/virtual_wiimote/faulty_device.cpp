#include "virtual_wiimote/faulty_device.h"

#include "second_master.h"

#include <algorithm>
#include <deque>
#include <optional>
#include <random>
#include <utility>

namespace wiimote_tracker::virtual_wiimote {
namespace {

constexpr std::size_t kLargestReport = 22;

bool isAnswer(const Bytes& report) {
  return report[0] >= 0x20 && report[0] <= 0x22;
}

}  // namespace

struct FaultyDevice::State {
  explicit State(const Device::Options& options) : device(options) {}

  struct Late {
    std::uint64_t due;
    Bytes report;
  };

  Device device;
  Faults faults;
  std::mt19937 random;
  std::optional<SecondMaster> second_master;

  std::uint64_t samples = 0;
  std::uint64_t stall_end = 0;
  bool away = false;
  std::uint64_t came_or_went = 0;
  std::vector<Late> late;
  std::deque<Bytes> held_back;

  std::vector<Bytes> arrived;  ///< Not yet handed to the host.

  bool chance(double probability) {
    return probability > 0.0 && random() < probability * 4294967296.0;
  }
  std::size_t below(std::size_t limit) { return random() % limit; }

  bool stalled() const { return samples < stall_end; }

  /// A host sends a report to the device.
  void say(const Bytes& report) {
    for (const Bytes& answer : device.handleOutput(report))
      send(answer);
  }

  /// The device sends a report, which may get lost.
  void send(Bytes report) {
    const bool answer = isAnswer(report);
    if (chance(answer ? faults.lost_answers : faults.lost_data))
      return;
    if (chance(faults.truncated))
      report.resize(1 + below(report.size()));
    const int copies = chance(faults.duplicated) ? 2 : 1;
    if (answer && chance(faults.late_answers)) {
      const std::uint64_t due = samples + 1 + below(static_cast<std::size_t>(faults.late_by));
      late.insert(late.end(), static_cast<std::size_t>(copies), {due, report});
      return;
    }
    for (int i = 0; i < copies; ++i)
      arrive(report);
  }

  /// A report reaches the host's end of the link; the second master receives it, too.
  void arrive(const Bytes& report) {
    if (stalled()) {
      held_back.push_back(report);
      return;
    }
    arrived.push_back(report);
    if (!second_master)
      return;
    for (const Bytes& said : second_master->hear(report))
      say(said);
  }

  void releaseHeldBack() {
    // Replies of the second master come after all of these.
    std::deque<Bytes> reports;
    reports.swap(held_back);
    for (const Bytes& report : reports)
      arrive(report);
  }

  void releaseLate() {
    const auto due = std::stable_partition(late.begin(), late.end(),
                                           [this](const Late& l) { return l.due > samples; });
    const std::vector<Late> reports(due, late.end());
    late.erase(due, late.end());
    for (const Late& report : reports)
      arrive(report.report);
  }

  /// A random report with an unknown id, or an answer with random contents.
  Bytes garbage() {
    Bytes report(1 + below(kLargestReport));
    std::generate(report.begin(), report.end(),
                  [this] { return static_cast<std::uint8_t>(random()); });
    if (below(2) == 0)
      report[0] = static_cast<std::uint8_t>(0x20 + below(3));
    else
      report[0] = static_cast<std::uint8_t>(0x40 + below(0xc0));
    return report;
  }

  void goAwayOrComeBack() {
    const int stay = away ? faults.unplug_for : faults.unplug_every;
    if (faults.unplug_every == 0 || samples - came_or_went < static_cast<std::uint64_t>(stay))
      return;
    const bool goes = !away;
    powerCycle();
    away = goes;
  }

  void powerCycle() {
    device.powerCycle();
    late.clear();
    held_back.clear();
    stall_end = 0;
    away = false;
    came_or_went = samples;
    if (faults.second_master)
      second_master = SecondMaster();
  }

  std::vector<Bytes> takeArrived() { return std::exchange(arrived, {}); }
};

FaultyDevice::FaultyDevice(const Device::Options& options, const Faults& faults)
    : state_(std::make_unique<State>(options)) {
  setFaults(faults);
}

FaultyDevice::~FaultyDevice() = default;

void FaultyDevice::setFaults(const Faults& faults) {
  State& state = *state_;
  state.faults = faults;
  state.random.seed(faults.seed);
  state.away = false;
  state.came_or_went = state.samples;
  state.second_master.reset();
  if (faults.second_master)
    state.second_master = SecondMaster();
}

std::vector<Bytes> FaultyDevice::handleOutput(const Bytes& report) {
  if (!state_->away)
    state_->say(report);
  return state_->takeArrived();
}

std::vector<Bytes> FaultyDevice::sample(const Senses& senses) {
  State& state = *state_;
  ++state.samples;
  state.goAwayOrComeBack();
  if (state.away)
    return {};
  if (!state.stalled()) {
    state.releaseHeldBack();
    if (state.chance(state.faults.stalls))
      state.stall_end = state.samples + static_cast<std::uint64_t>(state.faults.stall_length);
  }
  state.releaseLate();
  if (state.second_master) {
    for (const Bytes& said : state.second_master->tick())
      state.say(said);
  }
  if (state.chance(state.faults.garbage))
    state.arrive(state.garbage());
  if (const std::optional<Bytes> report = state.device.sample(senses))
    state.send(*report);
  return state.takeArrived();
}

std::vector<Bytes> FaultyDevice::setNunchuk(bool plugged) {
  const std::optional<Bytes> status = state_->device.setNunchuk(plugged);
  if (status && !state_->away)
    state_->send(*status);
  return state_->takeArrived();
}

void FaultyDevice::powerCycle() {
  state_->powerCycle();
}

bool FaultyDevice::away() const {
  return state_->away;
}

Device& FaultyDevice::device() {
  return state_->device;
}

const Device& FaultyDevice::device() const {
  return state_->device;
}

}  // namespace wiimote_tracker::virtual_wiimote
