#include "running_driver.h"

#include "clock.h"
#include "recovery.h"
#include "transport/transport.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>

namespace wiimote_tracker::real_kernel {
namespace {

constexpr double kTurn = 0.05;           // [s] Longest wait between checks whether to stop.
constexpr double kCommandTimeout = 5.0;  // [s]

}  // namespace

RunningDriver::RunningDriver(const std::string& device,
                             const Scene& scene,
                             ImageTotals& totals,
                             const wiimote::Options& options)
    : record_(scene),
      totals_(totals),
      options_(options),
      wiimote_(options, transport::opener(transport::parseDeviceName(device)), now),
      thread_([this] { run(); }) {}

RunningDriver::~RunningDriver() {
  stop_ = true;
  thread_.join();
}

void RunningDriver::run() {
  std::uint64_t link_changes = 0;
  while (!stop_) {
    const double idle = wiimote_.idleTime();
    if (idle > 0.0) {
      sleepFor(std::min(idle, kTurn));
      continue;
    }
    const std::optional<protocol::DataReport> image = wiimote_.step(kTurn);
    const std::lock_guard<std::mutex> lock(mutex_);
    if (command_) {
      command_(wiimote_);
      command_ = nullptr;
    }
    if (image)
      record(*image);
    if (link_changes != wiimote_.linkChanges()) {
      link_changes = wiimote_.linkChanges();
      link_ = wiimote_.link();
    }
  }
}

void RunningDriver::command(const std::function<void(wiimote::Wiimote&)>& action) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    command_ = action;
  }
  const bool done = waitFor(
      [&] {
        const std::lock_guard<std::mutex> lock(mutex_);
        return !command_;
      },
      kCommandTimeout);
  if (!done)
    throw std::runtime_error("the driver's thread hangs");
}

double RunningDriver::recoveryRate() const {
  return options_.ir_format == protocol::IrFormat::kFull ? 0.5 * kRecoveryRate : kRecoveryRate;
}

void RunningDriver::record(const protocol::DataReport& image) {
  if (!ImageRecord::showsLights(image))
    return;
  const std::string problem = record_.problemOf(image);
  totals_.add(problem);
  if (problem.empty())
    images_.push_back(now());
}

wiimote::Link RunningDriver::link() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return link_;
}

std::vector<double> RunningDriver::images() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return images_;
}

bool RunningDriver::waitForState(wiimote::Link::State state, double timeout) const {
  return waitFor([&] { return link().state == state; }, timeout);
}

}  // namespace wiimote_tracker::real_kernel
