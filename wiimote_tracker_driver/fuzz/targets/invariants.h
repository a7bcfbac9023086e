#pragma once

#include "wiimote_tracker_driver/protocol/input_reports.h"
#include "wiimote_tracker_driver/protocol/report.h"

#include <stdexcept>

namespace wiimote_tracker::fuzz {

/// An invariant of the driver that an input has violated.
struct Broken : std::logic_error {
  using std::logic_error::logic_error;
};

inline void require(bool kept, const char* promise) {
  if (!kept)
    throw Broken(promise);
}

/// Everything in a decoded data report is in its range. @throws Broken.
void requireInRange(const protocol::DataReport& data);

/// The image has that format, as a session returns it, and all its values are in range. @throws
/// Broken.
void requireImage(const protocol::DataReport& image, protocol::IrFormat format);

/// The remote would understand this output report. @throws Broken.
void requireWellFormed(const protocol::Report& output);

}  // namespace wiimote_tracker::fuzz
