#ifndef WIIMOTE_TRACKER_DRIVER_SIMULATED_LINK_H
#define WIIMOTE_TRACKER_DRIVER_SIMULATED_LINK_H

#include "wiimote_tracker_driver/virtual_wiimote/frame_times.h"

#include <cstdint>
#include <vector>

namespace wiimote_tracker::exposure_clock {

/// A Wii Remote's clock and link: period 10.035 ms +- 500 ppm, 5 % of the frames lost.
struct LinkModel : virtual_wiimote::FrameTimesModel {
  LinkModel();
};

struct SimulatedSession {
  double period;                                    ///< true period [s]
  std::vector<virtual_wiimote::FrameTime> reports;  ///< of frames that were not lost
};

/// Frames of `duration` seconds, by fixed seed.
SimulatedSession simulate(const LinkModel& link, double duration, std::uint64_t seed);

}  // namespace wiimote_tracker::exposure_clock

#endif
