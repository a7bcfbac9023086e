#include "big_words.h"

#include <QFontMetrics>
#include <QPainter>

#include <algorithm>

namespace wiimote_tracker::panel {
namespace {

constexpr int kWordsHeight = 96;  // [px of the screen]

}  // namespace

BigWords::BigWords(QWidget* parent) : QWidget(parent) {
  setFixedHeight(kWordsHeight);
}

void BigWords::setText(const QString& text) {
  if (text == text_)
    return;
  text_ = text;
  update();
}

void BigWords::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  QFont large = font();
  large.setBold(true);
  large.setPixelSize(height());
  const QRect words = QFontMetrics(large).boundingRect(text_);
  const double fit = std::min(1.0 * width() / std::max(words.width() + 8, 1),
                              1.0 * height() / QFontMetrics(large).height());
  large.setPixelSize(std::max(static_cast<int>(height() * fit), 1));
  painter.setFont(large);
  painter.setPen(palette().color(QPalette::WindowText));
  painter.drawText(rect(), Qt::AlignCenter, text_);
}

}  // namespace wiimote_tracker::panel
