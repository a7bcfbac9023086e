#ifndef WIIMOTE_TRACKER_DRIVER_ROS_LINK_DIAGNOSTICS_H
#define WIIMOTE_TRACKER_DRIVER_ROS_LINK_DIAGNOSTICS_H

#include "image_stamper.h"
#include "wiimote_tracker_driver/wiimote/stream_statistics.h"
#include "wiimote_tracker_driver/wiimote/wiimote.h"

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <cstdint>
#include <string>

namespace wiimote_tracker::driver {

/// How the driver is, at one time.
struct DriverState {
  wiimote::Link link;
  wiimote::StreamStatistics::Summary stream;
  exposure_clock::Statistics clock;
  ImageStamper::Totals totals;
  double stamp_stddev = 0.0;  ///< Of the last image [s]; NaN when exposures are not estimated.
  std::string shared_with;    ///< One sentence on other users; empty when there are none.
  std::string ir_sensitivity;
  std::string reader_priority;
  std::string recording;        ///< File; empty when none is written.
  std::string recording_error;  ///< One sentence; empty when all is well.
};

/// Says it in /diagnostics.
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
  std::uint64_t restorations_ = 0;  // that were told already
};

}  // namespace wiimote_tracker::driver

#endif  // WIIMOTE_TRACKER_DRIVER_ROS_LINK_DIAGNOSTICS_H
