#ifndef WIIMOTE_TRACKER_BRINGUP_IMPORT_BAG_H
#define WIIMOTE_TRACKER_BRINGUP_IMPORT_BAG_H

#include "solution.h"

#include <string>

namespace wiimote_tracker::import {

/// Writes a solution as a bag like that of a live tracker (topics: README.md). Equal solutions give
/// equal files. @throws ImportError: the bag cannot be written.
void writeBag(const Solution& solution, const std::string& path);

}  // namespace wiimote_tracker::import

#endif  // WIIMOTE_TRACKER_BRINGUP_IMPORT_BAG_H
