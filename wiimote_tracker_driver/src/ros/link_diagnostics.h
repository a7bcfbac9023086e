#pragma once

#include "image_stamper.h"
#include "wiimote/stream_statistics.h"
#include "wiimote/wiimote.h"

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <cstdint>
#include <string>

namespace wiimote_tracker::driver {

/// State of the driver at one time.
struct DriverState {
  wiimote::Link link;
  wiimote::StreamStatistics::Summary stream;
  exposure_clock::Statistics clock;
  ImageStamper::Totals totals;
  double stamp_stddev = 0.0;  ///< Of the last image [s]; NaN when exposures are not estimated.
  bool replayed = false;      ///< The reports are those of a recording.
  std::string shared_with;    ///< A sentence about other programs; empty without any.
  std::string ir_sensitivity;
  std::string reader_priority;
  std::string recording;        ///< Its file; empty without one.
  std::string recording_error;  ///< A sentence; empty without an error.
};

/// Fills the status in /diagnostics.
class LinkDiagnostics {
 public:
  /// `image_rate`: nominal [Hz]; `battery_low`: charge [0..1] below which it is low.
  LinkDiagnostics(protocol::IrFormat ir_format, double image_rate, double battery_low);

  void describe(const DriverState& state, diagnostic_updater::DiagnosticStatusWrapper& status);

 private:
  void summarise(const DriverState& state, diagnostic_updater::DiagnosticStatusWrapper& status);
  void summariseStream(const DriverState& state,
                       diagnostic_updater::DiagnosticStatusWrapper& status);

  const protocol::IrFormat ir_format_;
  const double image_rate_;
  const double battery_low_;
  std::uint64_t restorations_ = 0;  // reported already
  std::uint64_t gaps_ = 0;          // reported already
};

}  // namespace wiimote_tracker::driver
