#pragma once

#include "image_record.h"
#include "wiimote/wiimote.h"

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace wiimote_tracker::real_kernel {

/// The driver's core over hidapi and hidraw, in its own thread as in the driver node.
class RunningDriver {
 public:
  /// `device` as in the driver's parameter: empty, a Bluetooth address or /dev/hidrawN. `scene` is
  /// what the remote sees; its images count in `totals`.
  RunningDriver(const std::string& device,
                const Scene& scene,
                ImageTotals& totals,
                const wiimote::Options& options = {});
  ~RunningDriver();

  /// Runs this in the driver's thread, and waits for it.
  void command(const std::function<void(wiimote::Wiimote&)>& action);

  /// Images a second of an undisturbed stream, less a tenth [Hz].
  double recoveryRate() const;

  wiimote::Link link() const;

  /// Arrival times of the images that show the scene [s].
  std::vector<double> images() const;

  /// Waits until the link is in this state, at most `timeout` [s].
  bool waitForState(wiimote::Link::State state, double timeout) const;

 private:
  void run();
  void record(const protocol::DataReport& image);

  ImageRecord record_;
  ImageTotals& totals_;
  const wiimote::Options options_;
  wiimote::Wiimote wiimote_;

  mutable std::mutex mutex_;  // guards the next three
  std::function<void(wiimote::Wiimote&)> command_;
  wiimote::Link link_;
  std::vector<double> images_;

  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace wiimote_tracker::real_kernel
