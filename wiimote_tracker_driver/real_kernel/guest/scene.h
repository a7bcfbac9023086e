#pragma once

#include "wiimote_tracker_driver/protocol/input_reports.h"
#include "wiimote_tracker_driver/virtual_wiimote/device.h"

#include <atomic>
#include <optional>
#include <vector>

namespace wiimote_tracker::real_kernel {

/// What one remote sees: four lights of different sizes that move together around a square, by one
/// pixel in each frame. So an image tells when it was taken. Thread-safe.
class Scene {
 public:
  /// Scenes of different numbers, 1 to 7, have no position of a light in common.
  explicit Scene(int number = 1) : number_(number) {}

  /// The lights in front of the camera at the next frame.
  std::vector<virtual_wiimote::Light> next();

  /// Frames so far.
  long frame() const { return frame_; }

  /// The last frame at which exactly these lights were in front of the camera; nothing if there is
  /// none among the last 256 frames. In the basic format sizes are unknown. `tolerance`: in each
  /// direction [px].
  std::optional<long> frameOf(const protocol::DataReport& image, int tolerance = 0) const;

 private:
  std::vector<virtual_wiimote::Light> lightsAt(long frame) const;

  const int number_;
  std::atomic<long> frame_{0};
};

}  // namespace wiimote_tracker::real_kernel
