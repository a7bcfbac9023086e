#ifndef WIIMOTE_TRACKER_BRINGUP_SIMULATION_CAMERA_CLOCK_H
#define WIIMOTE_TRACKER_BRINGUP_SIMULATION_CAMERA_CLOCK_H

#include "description.h"

#include <cstdint>
#include <random>

namespace wiimote_tracker::simulation {

/// One image: when the light was collected, and when its report arrives [s].
struct Exposure {
  double time;
  double delivery;
};

/// A camera's own clock and its link: exposures at phase + n * period, delivered after a delay that
/// varies, but in order.
class CameraClock {
 public:
  CameraClock(const Timing& timing, std::uint32_t seed) : timing_(timing), random_(seed) {}

  /// The next exposure, from the first one on.
  Exposure next();

 private:
  Timing timing_;
  std::mt19937 random_;
  std::uint64_t count_ = 0;
  double last_delivery_ = 0.0;
};

}  // namespace wiimote_tracker::simulation

#endif  // WIIMOTE_TRACKER_BRINGUP_SIMULATION_CAMERA_CLOCK_H
