#include "camera_clock.h"

#include <algorithm>

namespace wiimote_tracker::simulation {

Exposure CameraClock::next() {
  Exposure exposure;
  exposure.time = timing_.phase + static_cast<double>(count_++) * timing_.period;
  exposure.delivery = exposure.time + timing_.delay;
  if (timing_.jitter > 0.0)
    exposure.delivery += std::exponential_distribution<double>(1.0 / timing_.jitter)(random_);
  exposure.delivery = last_delivery_ = std::max(exposure.delivery, last_delivery_);
  return exposure;
}

}  // namespace wiimote_tracker::simulation
