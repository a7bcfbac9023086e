#ifndef WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_FIGURE_H
#define WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_FIGURE_H

#include <QString>

#include <cmath>

namespace wiimote_tracker::panel {

/// A number of a table; "-" where it is not known.
inline QString figure(double value, int decimals) {
  return std::isfinite(value) ? QString::number(value, 'f', decimals) : "-";
}

}  // namespace wiimote_tracker::panel

#endif  // WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_FIGURE_H
