#ifndef WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_TRACKER_WIDGET_H
#define WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_TRACKER_WIDGET_H

#include "link.h"
#include "tracker_view.h"

#include <QWidget>

class QTabWidget;

namespace wiimote_tracker::panel {

class CamerasPage;

/// The panel without rviz: pages, and a timer that draws the one in front.
class TrackerWidget : public QWidget {
 public:
  explicit TrackerWidget(QWidget* parent);

  QTabWidget* pages() const { return pages_; }

 private:
  void refresh();

  TrackerView view_;
  Link link_{&view_};
  QTabWidget* pages_;
  CamerasPage* cameras_;
};

}  // namespace wiimote_tracker::panel

#endif  // WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_TRACKER_WIDGET_H
