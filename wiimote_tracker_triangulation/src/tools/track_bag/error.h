#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_ERROR_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_ERROR_H

#include <stdexcept>

namespace wiimote_tracker {

/// A bag cannot be read, used or written. what() is one sentence that says what to do.
struct BagError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_ERROR_H
