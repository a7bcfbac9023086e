#ifndef WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_RUNNING_DRIVER_H
#define WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_RUNNING_DRIVER_H

#include "wiimote/wiimote.h"
#include "wiimote_tracker_driver/virtual_wiimote/device.h"

#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace wiimote_tracker::real_kernel {

/// The driver's core over hidapi and hidraw, in its own thread as in the driver node.
class RunningDriver {
 public:
  /// `device` as in the driver's parameter: empty, a Bluetooth address or /dev/hidrawN. `light` is
  /// the only one that the remote sees.
  RunningDriver(const std::string& device,
                const virtual_wiimote::Light& light,
                const wiimote::SessionOptions& options = {});
  ~RunningDriver();

  /// Runs this in the driver's thread, and waits for it.
  void command(const std::function<void(wiimote::Wiimote&)>& action);

  /// Images a second of an undisturbed stream, less a tenth [Hz].
  double recoveryRate() const;

  wiimote::Link link() const;

  /// Arrival times of the images that show the light [s].
  std::vector<double> images() const;

  /// Number of images with another light. Images without any light do not count.
  std::size_t wrongImages() const;

  /// Waits until the link is in this state, at most `timeout` [s].
  bool waitForState(wiimote::Link::State state, double timeout) const;

 private:
  void run();
  void record(const protocol::DataReport& image);

  const virtual_wiimote::Light light_;
  const wiimote::SessionOptions options_;
  wiimote::Wiimote wiimote_;

  mutable std::mutex mutex_;  // guards the next four
  std::function<void(wiimote::Wiimote&)> command_;
  wiimote::Link link_;
  std::vector<double> images_;
  std::size_t wrong_images_ = 0;

  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace wiimote_tracker::real_kernel

#endif  // WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_RUNNING_DRIVER_H
