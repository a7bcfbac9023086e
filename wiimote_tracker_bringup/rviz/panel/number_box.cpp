#include "number_box.h"

#include <QWheelEvent>

namespace wiimote_tracker::panel {

NumberBox::NumberBox(QWidget* parent) : QDoubleSpinBox(parent) {
  setLocale(QLocale::c());
}

/// Qt would drop the comma, or a German point, and keep the digits: 1,5 became 15.
QValidator::State NumberBox::validate(QString& text, int& position) const {
  text.replace(',', '.');
  return QDoubleSpinBox::validate(text, position);
}

void NumberBox::wheelEvent(QWheelEvent* event) {
  event->ignore();
}

}  // namespace wiimote_tracker::panel
