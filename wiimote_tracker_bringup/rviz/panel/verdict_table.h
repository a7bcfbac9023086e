#pragma once

#include <wiimote_tracker_msgs/CalibrationVerdict.h>

#include <QWidget>

#include <string>

class QLabel;

namespace wiimote_tracker::panel {

class Table;

/// The verdict on a rig in words, and the quality of each camera.
class VerdictTable : public QWidget {
 public:
  explicit VerdictTable(QWidget* parent);

  /// @param verdict null: there is none, and nothing is shown.
  void show(const wiimote_tracker_msgs::CalibrationVerdict* verdict);

 private:
  QLabel* words_;
  Table* table_;
  std::string shown_rig_;
};

}  // namespace wiimote_tracker::panel
