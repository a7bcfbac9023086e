#pragma once

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QWheelEvent>

/// What is typed and chosen changes only where a person clicks: the wheel scrolls the page.
namespace wiimote_tracker::panel {

class ChoiceBox : public QComboBox {
 public:
  using QComboBox::QComboBox;

 protected:
  void wheelEvent(QWheelEvent* event) override { event->ignore(); }
};

/// A number; in every language a point or a comma stands before the decimals.
class NumberBox : public QDoubleSpinBox {
 public:
  explicit NumberBox(QWidget* parent) : QDoubleSpinBox(parent) { setLocale(QLocale::c()); }

 protected:
  /// Qt would drop the comma, or a German point, and keep the digits: 1,5 became 15.
  QValidator::State validate(QString& text, int& position) const override {
    text.replace(',', '.');
    return QDoubleSpinBox::validate(text, position);
  }
  void wheelEvent(QWheelEvent* event) override { event->ignore(); }
};

}  // namespace wiimote_tracker::panel
