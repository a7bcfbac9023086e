#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_MESSAGE_BYTES_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_MESSAGE_BYTES_H

#include <cstdint>
#include <vector>

namespace wiimote_tracker {

/// A message as it is in a bag.
using MessageBytes = std::vector<std::uint8_t>;

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_MESSAGE_BYTES_H
