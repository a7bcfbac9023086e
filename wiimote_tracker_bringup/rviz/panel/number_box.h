#ifndef WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_NUMBER_BOX_H
#define WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_NUMBER_BOX_H

#include <QDoubleSpinBox>

namespace wiimote_tracker::panel {

/// A number that changes only where a person types it: in every language a point or a comma stands
/// before the decimals, and the wheel, which scrolls the page, leaves it alone.
class NumberBox : public QDoubleSpinBox {
 public:
  explicit NumberBox(QWidget* parent);

 protected:
  QValidator::State validate(QString& text, int& position) const override;
  void wheelEvent(QWheelEvent* event) override;
};

}  // namespace wiimote_tracker::panel

#endif  // WIIMOTE_TRACKER_BRINGUP_RVIZ_PANEL_NUMBER_BOX_H
