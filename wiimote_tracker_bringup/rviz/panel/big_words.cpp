#include "big_words.h"

#include <QFontMetrics>
#include <QPainter>

#include <algorithm>

namespace wiimote_tracker::panel {

BigWords::BigWords(QWidget* parent) : QLabel(parent) {
  setFixedHeight(96);  // [px of the screen]
}

void BigWords::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  QFont large = font();
  large.setBold(true);
  large.setPixelSize(height());
  const QRect words = QFontMetrics(large).boundingRect(text());
  const double fit = std::min(1.0 * width() / std::max(words.width() + 8, 1),
                              1.0 * height() / QFontMetrics(large).height());
  large.setPixelSize(std::max(static_cast<int>(height() * fit), 1));
  painter.setFont(large);
  painter.setPen(palette().color(QPalette::WindowText));
  painter.drawText(rect(), Qt::AlignCenter, text());
}

}  // namespace wiimote_tracker::panel
