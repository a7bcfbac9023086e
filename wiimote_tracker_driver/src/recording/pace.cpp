#include "wiimote_tracker_driver/recording/replay.h"

#include <chrono>
#include <optional>
#include <stdexcept>
#include <thread>

namespace wiimote_tracker::recording {

Pace realTime(double speed) {
  using Clock = std::chrono::steady_clock;
  if (!(speed > 0.0))
    throw std::invalid_argument("a recording is played at a speed above 0");
  struct Start {
    Clock::time_point present;
    double recorded;  // [s]
  };
  return [speed, start = std::optional<Start>()](double time) mutable {
    if (!start)
      start = Start{Clock::now(), time};
    const std::chrono::duration<double> duration((time - start->recorded) / speed);
    std::this_thread::sleep_until(start->present +
                                  std::chrono::duration_cast<Clock::duration>(duration));
  };
}

}  // namespace wiimote_tracker::recording
