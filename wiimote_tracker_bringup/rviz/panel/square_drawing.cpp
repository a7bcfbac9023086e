#include "square_drawing.h"

#include <QPainter>

#include <algorithm>
#include <array>

namespace wiimote_tracker::panel {
namespace {

using wiimote_tracker_msgs::CalibrationStatus;

constexpr int kBorder = 34;  // around the square [px of the screen]
constexpr int kRadius = 15;  // of a corner's disc [px of the screen]
const QColor kDone(46, 158, 79), kNext(230, 140, 0);

QString metres(double length) {
  return QString("%1 m").arg(length, 0, 'g', 4);
}

}  // namespace

SquareDrawing::SquareDrawing(QWidget* parent) : QWidget(parent) {
  setFixedHeight(180);
}

void SquareDrawing::show(const CalibrationStatus& status, int again) {
  if (status.step == status_.step && status.corners_captured == status_.corners_captured &&
      status.square_sides == status_.square_sides && again == again_)
    return;
  status_ = status;
  again_ = again;
  update();
}

void SquareDrawing::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const bool has_sides = status_.square_sides.size() == 2;
  const double ratio = has_sides ? status_.square_sides[0] / status_.square_sides[1] : 1.0;
  const double room_x = width() - 2.0 * kBorder, room_y = height() - 2.0 * kBorder;
  const double scale = std::min(room_x / ratio, room_y);
  const QSizeF size(scale * ratio, scale);
  const QRectF area(QPointF((width() - size.width()) / 2, (height() - size.height()) / 2), size);
  // Seen from above with x to the right: counter-clockwise from the lower left corner.
  const std::array<QPointF, 4> corners = {area.bottomLeft(), area.bottomRight(), area.topRight(),
                                          area.topLeft()};
  const QColor text = palette().color(QPalette::WindowText);
  painter.setPen(QPen(text, 2));
  painter.drawRect(area);
  if (has_sides) {
    painter.drawText(QRectF(area.left(), area.bottom() + 4, area.width(), kBorder - 4),
                     Qt::AlignHCenter | Qt::AlignTop, "x  " + metres(status_.square_sides[0]));
    painter.drawText(QRectF(area.right() + 8, area.top(), 120, area.height()),
                     Qt::AlignVCenter | Qt::AlignLeft, "y  " + metres(status_.square_sides[1]));
  }
  const bool takes_corners =
      status_.step == CalibrationStatus::READY || status_.step == CalibrationStatus::CAPTURING;
  QFont bold = font();
  bold.setBold(true);
  painter.setFont(bold);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const bool is_next = again_ >= 0 ? static_cast<std::size_t>(again_) == i
                                     : takes_corners && status_.corners_captured == i;
    const bool is_done = !is_next && i < status_.corners_captured;
    painter.setPen(QPen(is_next ? kNext : is_done ? kDone : text, 2));
    painter.setBrush(is_next ? kNext : is_done ? kDone : palette().color(QPalette::Window));
    const double radius = is_next ? 1.3 * kRadius : kRadius;
    painter.drawEllipse(corners[i], radius, radius);
    painter.setPen(is_next || is_done ? QColor(Qt::black) : text);
    painter.drawText(
        QRectF(corners[i].x() - kRadius, corners[i].y() - kRadius, 2 * kRadius, 2 * kRadius),
        Qt::AlignCenter, QString::number(i + 1));
  }
}

}  // namespace wiimote_tracker::panel
