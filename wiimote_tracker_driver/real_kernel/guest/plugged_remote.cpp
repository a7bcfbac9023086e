#include "plugged_remote.h"

#include "clock.h"

#include <algorithm>
#include <chrono>

namespace wiimote_tracker::real_kernel {

PluggedRemote::PluggedRemote(const std::string& address, Scene& scene, Model model)
    : scene_(scene), device_(address, options(model)), thread_([this] { run(); }) {}

virtual_wiimote::UhidDevice::Options PluggedRemote::options(Model model) {
  virtual_wiimote::UhidDevice::Options options;
  options.model = model;
  options.latency = 0.012;
  options.listener = [this](const Bytes& report) {
    const std::lock_guard<std::mutex> lock(mutex_);
    outputs_.push_back({now(), report});
  };
  return options;
}

PluggedRemote::~PluggedRemote() {
  stop_ = true;
  thread_.join();
}

void PluggedRemote::mute() {
  virtual_wiimote::Faults faults;
  faults.lost_answers = faults.lost_data = 1.0;
  device_.setFaults(faults);
}

void PluggedRemote::run() {
  virtual_wiimote::Senses senses;
  auto next = std::chrono::steady_clock::now();
  while (!stop_) {
    next += std::chrono::milliseconds(10);
    std::this_thread::sleep_until(next);
    senses.lights = scene_.next();
    device_.sample(senses);
  }
}

std::vector<PluggedRemote::Output> PluggedRemote::outputs(double since) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto begin = std::find_if(outputs_.begin(), outputs_.end(),
                                  [since](const Output& output) { return output.time >= since; });
  return std::vector<Output>(begin, outputs_.end());
}

bool PluggedRemote::got(const Bytes& beginning, double since) const {
  const std::vector<Output> all = outputs(since);
  return std::any_of(all.begin(), all.end(), [&](const Output& output) {
    return output.report.size() >= beginning.size() &&
           std::equal(beginning.begin(), beginning.end(), output.report.begin());
  });
}

}  // namespace wiimote_tracker::real_kernel
