#ifndef WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_VIEWS_H
#define WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_VIEWS_H

#include "guide.h"
#include "health_view.h"
#include "tracker_view.h"
#include "tracks_view.h"

namespace wiimote_tracker::panel {

/// What the pages show.
struct Views {
  TrackerView cameras;
  Guide guide;
  TracksView tracks;
  HealthView health;
};

}  // namespace wiimote_tracker::panel

#endif  // WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_VIEWS_H
