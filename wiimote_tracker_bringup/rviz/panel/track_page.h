#pragma once

#include "recorder.h"
#include "tracks_view.h"

#include <QWidget>

#include <rviz/config.h>

class QLabel;
class QLineEdit;
class QPushButton;

namespace wiimote_tracker::panel {

class Table;

/// LEDs and bodies with their places and uncertainties, the latest events, and a record button.
class TrackPage : public QWidget {
 public:
  explicit TrackPage(QWidget* parent);

  /// To be called also while another page is in front, since a recording goes on.
  void poll() { recorder_.poll(); }
  void show(const TracksView& tracks, double now);

  /// What was typed, in the .rviz file.
  void load(const rviz::Config& config);
  void save(rviz::Config* config) const;

 private:
  Recorder recorder_;
  QLabel *summary_, *events_, *recording_;
  Table *leds_, *bodies_;
  QLineEdit* path_;
  QPushButton* record_;
};

}  // namespace wiimote_tracker::panel
