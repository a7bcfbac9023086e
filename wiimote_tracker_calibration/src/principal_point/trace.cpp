#include "wiimote_tracker_calibration/principal_point/trace.h"

#include <cstdio>

namespace wiimote_tracker::principal_point {

std::string table(const Trace& trace) {
  std::string text = "round  origin [mm]  corners [mm]";
  for (const std::string& camera : trace.cameras)
    text += "  " + camera + " cx, cy [px]";
  text += "\n";
  char cell[96];
  for (std::size_t i = 0; i < trace.rounds.size(); ++i) {
    const Round& round = trace.rounds[i];
    std::snprintf(cell, sizeof cell, "%5zu  %11.1f  %12.1f", i, 1e3 * round.origin_error,
                  1e3 * round.corner_error);
    text += cell;
    for (std::size_t c = 0; c < round.principal_points.size(); ++c) {
      const int width = static_cast<int>(trace.cameras[c].size()) + 7;
      std::snprintf(cell, sizeof cell, "  %*.1f, %6.1f", width, round.principal_points[c].x(),
                    round.principal_points[c].y());
      text += cell;
    }
    text += "\n";
  }
  return text;
}

}  // namespace wiimote_tracker::principal_point
