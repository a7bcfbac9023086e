#pragma once

#include "scene.h"
#include "virtual_wiimote/uhid.h"

#include <atomic>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace wiimote_tracker::real_kernel {

/// A virtual Wii Remote plugged into this kernel. It looks at its scene 100 times a second
/// and records output reports of the kernel and of drivers.
class PluggedRemote {
 public:
  using Bytes = virtual_wiimote::Bytes;
  using Model = virtual_wiimote::UhidDevice::Model;

  /// An output report and when it reached the remote [s].
  struct Output {
    double time = 0.0;
    Bytes report;
  };

  /// Transit time of output reports is 12 ms.
  PluggedRemote(const std::string& address, Scene& scene, Model model = Model::kRemote);
  ~PluggedRemote();

  void unplug() { device_.setPresent(false); }
  void plug() { device_.setPresent(true); }
  /// From now on it answers nothing and sends nothing.
  void mute();
  void setNunchuk(bool plugged) { device_.setNunchuk(plugged); }

  std::uint8_t leds() const { return device_.leds(); }
  bool rumble() const { return device_.rumble(); }

  /// All output reports that came at or after `since` [s].
  std::vector<Output> outputs(double since = 0.0) const;

  /// Whether an output report that begins with these bytes came at or after `since` [s].
  bool got(const Bytes& beginning, double since) const;

 private:
  virtual_wiimote::UhidDevice::Options options(Model model);
  void run();

  Scene& scene_;

  mutable std::mutex mutex_;  // guards the next
  std::vector<Output> outputs_;

  virtual_wiimote::UhidDevice device_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace wiimote_tracker::real_kernel
