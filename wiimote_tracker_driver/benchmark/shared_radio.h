#pragma once

#include "wiimote_tracker_driver/virtual_wiimote/frame_times.h"

#include <cstdint>
#include <vector>

namespace wiimote_tracker::exposure_clock {

/// Wii Remotes that share one Bluetooth adapter (Bluetooth Core, Vol 2 Part B: basic rate). Time on
/// the air is divided into slots of 0.625 ms. The adapter polls one remote in a slot, and the
/// remote answers in the next one with at most one report, which fits into one slot (DH1: 27
/// bytes).
struct RadioModel {
  int remotes = 1;
  /// Probability that the poll or the answer is not understood. The remote then sends the same
  /// report when it is polled again.
  double loss = 0.0;
  /// The order of polls, which adapters choose as they like.
  enum class Polling {
    kAtRandom,  ///< any remote at any time
    kInTurn,
    kSniff  ///< each remote once per interval, in which it listens to nothing else
  };
  Polling polling = Polling::kAtRandom;
  int sniff_interval = 16;  ///< [slots] At least twice the number of remotes.
  /// Reports that wait in a remote; a new one replaces the newest when all places are taken.
  /// Assumed: what real remotes do is unknown.
  int queue = 2;
};

/// The reports of each remote that reached the computer during `duration` [s]. Cameras have a
/// period of 10.035 ms +- 500 ppm and independent phases.
std::vector<std::vector<virtual_wiimote::FrameTime>> simulateRadio(const RadioModel& model,
                                                                   double duration,
                                                                   std::uint64_t seed);

}  // namespace wiimote_tracker::exposure_clock
