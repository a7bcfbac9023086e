#pragma once

#include "requests.h"
#include "ros_input.h"

#include <rviz/panel.h>

class QLabel;
class QTabWidget;

namespace wiimote_tracker::panel {

class CalibratePage;
class CamerasPage;
class HealthPage;
class TrackPage;

/// The panel in rviz: pages, and a timer that draws the one in front. Above them it says what is
/// wrong with the ROS master. The .rviz file keeps which page is in front, and what was typed.
class TrackerPanel : public rviz::Panel {
 public:
  TrackerPanel();

  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;

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
