#pragma once

#include "rooms/walker.h"

#include <cstddef>
#include <vector>

namespace wiimote_tracker::rooms {

// Which ends of tracks are taken for an LED that is carried through the door:
constexpr double kLongestHidden = 3.0;  ///< An LED is hidden for at most this long [s].
constexpr double kShortestPart = 0.7;   ///< Of each track, next to the door, at least [s].
constexpr double kSlowest = 0.5;        ///< Speed [m/s].

/// An LED that went from one room to the other, in the order of time. Each path is in the world of
/// its room, thinned, next to the door.
struct Passage {
  bool from_first;  ///< From the first room to the second.
  Path before;
  Path after;
};

struct Passages {
  std::vector<Passage> passages;  ///< In the order of time.
  /// Left out: several LEDs may have gone through the door at the same time.
  std::size_t crowded = 0;
  std::size_t crooked = 0;   ///< Left out: not straight.
  std::size_t unhidden = 0;  ///< Left out: both rooms saw an LED, maybe the same, at that time.
};

/// Pairs the end of a track in one room with the beginning of one in the other.
/// @param first_tracks, second_tracks in each room, points in the order of time; an LED may have
/// several, also at the same time.
Passages findPassages(const std::vector<Path>& first_tracks,
                      const std::vector<Path>& second_tracks);

}  // namespace wiimote_tracker::rooms
