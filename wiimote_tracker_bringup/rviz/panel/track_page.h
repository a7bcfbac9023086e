#ifndef WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_TRACK_PAGE_H
#define WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_TRACK_PAGE_H

#include "recorder.h"
#include "tracks_view.h"

#include <QWidget>

#include <vector>

class QLabel;
class QLineEdit;
class QPushButton;
class QTableWidget;

namespace wiimote_tracker::panel {

/// LEDs and bodies with their places and uncertainties, the latest events, and a record button.
class TrackPage : public QWidget {
 public:
  explicit TrackPage(QWidget* parent);

  void show(const TracksView& tracks, double now);

  QString recordPath() const;
  void setRecordPath(const QString& path);

 private:
  static QTableWidget* addTable(const QString& name, const QString& seen_by, QWidget* parent);
  static void fill(QTableWidget* table, const std::vector<TracksView::Row>& rows);

  Recorder recorder_;
  QLabel *summary_, *events_, *recording_;
  QTableWidget *leds_, *bodies_;
  QLineEdit* path_;
  QPushButton* record_;
};

}  // namespace wiimote_tracker::panel

#endif  // WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_TRACK_PAGE_H
