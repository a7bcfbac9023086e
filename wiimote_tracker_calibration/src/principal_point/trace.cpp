#include "wiimote_tracker_calibration/principal_point/correction.h"

#include <wiimote_tracker_msgs/text.h>

namespace wiimote_tracker::principal_point {

std::string table(const Trace& trace) {
  std::string text = "round  origin [mm]  corners [mm]";
  for (const std::string& camera : trace.cameras)
    text += "  " + camera + " cx, cy [px]";
  text += "\n";
  for (std::size_t i = 0; i < trace.rounds.size(); ++i) {
    const Round& round = trace.rounds[i];
    text += format("%5zu  %11.1f  %12.1f", i, 1e3 * round.origin_error, 1e3 * round.corner_error);
    for (std::size_t c = 0; c < round.principal_points.size(); ++c) {
      const int width = static_cast<int>(trace.cameras[c].size()) + 7;
      text += format("  %*.1f, %6.1f", width, round.principal_points[c].x(),
                     round.principal_points[c].y());
    }
    text += "\n";
  }
  return text;
}

}  // namespace wiimote_tracker::principal_point
