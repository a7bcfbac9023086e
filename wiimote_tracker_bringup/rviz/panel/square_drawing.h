#pragma once

#include <wiimote_tracker_msgs/CalibrationStatus.h>

#include <QWidget>

namespace wiimote_tracker::panel {

/// The square on the floor, seen from above: the corners that are captured, the next one, the
/// sides.
class SquareDrawing : public QWidget {
 public:
  explicit SquareDrawing(QWidget* parent);

  /// @param again corner to take again, 0..3; -1: none
  void show(const wiimote_tracker_msgs::CalibrationStatus& status, int again);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  wiimote_tracker_msgs::CalibrationStatus status_;
  int again_ = -1;
};

}  // namespace wiimote_tracker::panel
