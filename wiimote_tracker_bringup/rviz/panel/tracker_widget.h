#ifndef WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_TRACKER_WIDGET_H
#define WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_TRACKER_WIDGET_H

#include "guide.h"
#include "link.h"
#include "requests.h"
#include "tracker_view.h"

#include <QWidget>

class QTabWidget;

namespace wiimote_tracker::panel {

class CalibratePage;
class CamerasPage;

/// The panel without rviz: pages, and a timer that draws the one in front.
class TrackerWidget : public QWidget {
 public:
  explicit TrackerWidget(QWidget* parent);

  QTabWidget* pages() const { return pages_; }
  CalibratePage* calibratePage() const { return calibrate_; }

 private:
  void refresh();

  TrackerView view_;
  Guide guide_;
  Link link_{&view_, &guide_};
  Requests requests_{&guide_};
  QTabWidget* pages_;
  CamerasPage* cameras_;
  CalibratePage* calibrate_;
};

}  // namespace wiimote_tracker::panel

#endif  // WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_TRACKER_WIDGET_H
