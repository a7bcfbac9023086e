#ifndef WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_TRACKER_WIDGET_H
#define WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_TRACKER_WIDGET_H

#include "requests.h"
#include "ros_input.h"
#include "views.h"

#include <QWidget>

class QLabel;
class QTabWidget;

namespace wiimote_tracker::panel {

class CalibratePage;
class CamerasPage;
class HealthPage;
class TrackPage;

/// The panel without rviz: pages, and a timer that draws the one in front. Above them it says what
/// is wrong with the ROS master.
class TrackerWidget : public QWidget {
 public:
  explicit TrackerWidget(QWidget* parent);

  QTabWidget* pages() const { return pages_; }
  CalibratePage* calibratePage() const { return calibrate_; }
  TrackPage* trackPage() const { return track_; }

 private:
  void refresh();

  Views views_;
  RosInput ros_input_{&views_};
  Requests requests_{&views_.guide};
  QLabel* master_;
  QTabWidget* pages_;
  CamerasPage* cameras_;
  CalibratePage* calibrate_;
  TrackPage* track_;
  HealthPage* health_;
};

}  // namespace wiimote_tracker::panel

#endif  // WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_TRACKER_WIDGET_H
