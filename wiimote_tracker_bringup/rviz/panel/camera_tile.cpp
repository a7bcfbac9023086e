#include "camera_tile.h"

#include <QColor>
#include <QFontMetrics>
#include <QPainter>
#include <QStringList>
#include <QTextLayout>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::panel {
namespace {

constexpr int kMargin = 6;                      // [px of the screen]
constexpr int kMostLines = 3;                   // of words: the picture is to be seen
constexpr int kCellColumns = 8, kCellRows = 6;  // as CalibrationCameraStatus.image_cells
constexpr int kCells = kCellColumns * kCellRows;
constexpr double kWiimoteRatio = 768.0 / 1024.0;  // height by width, until an image tells them
const QColor kGround(30, 33, 40), kPicture(12, 13, 17), kText(232, 235, 240), kFaint(150, 156, 168);
const QColor kSpot(255, 244, 214), kMask(90, 94, 104), kCell(60, 130, 200, 70);

/// For the state's border and words; legible on the tiles' dark ground.
QColor colorOf(CameraState state) {
  return state == CameraState::kKnocked         ? QColor(255, 92, 92)
         : state == CameraState::kWarned        ? QColor(255, 176, 46)
         : state == CameraState::kLate          ? QColor(255, 176, 46)
         : state == CameraState::kNotCalibrated ? QColor(96, 165, 250)
         : state == CameraState::kBlind         ? QColor(240, 222, 90)
         : state == CameraState::kFine          ? QColor(74, 205, 120)
                                                : kFaint;  // without images, or unknown
}

}  // namespace

void CameraTile::show(const CameraView& camera,
                      CameraState state,
                      const std::string& words,
                      double now) {
  words_ = QString::fromStdString(words);
  QString all = words_;
  if (!camera.status.problem.empty())
    all += "\n" + QString::fromStdString(camera.status.problem);
  if (std::isfinite(camera.battery))
    all += QString("\nbattery: %1 %").arg(100.0 * camera.battery, 0, 'f', 0);
  setToolTip(all);
  if (visibleRegion().isEmpty())
    return;
  camera_ = camera;
  state_ = state;
  now_ = now;
  update();
}

int CameraTile::lineHeight() const {
  return fontMetrics().height() + 2;
}

int CameraTile::heightForWidth(int width) const {
  const bool has_size = camera_ && camera_->image && camera_->image->width > 0;
  const double ratio = has_size
                           ? static_cast<double>(camera_->image->height) / camera_->image->width
                           : kWiimoteRatio;
  return static_cast<int>((width - 2 * kMargin) * ratio) + 2 * lineHeight() + 2 * kMargin;
}

QRectF CameraTile::pictureArea() const {
  return QRectF(kMargin, kMargin + lineHeight(), width() - 2 * kMargin,
                height() - 2 * kMargin - 2 * lineHeight());
}

void CameraTile::paintEvent(QPaintEvent*) {
  if (!camera_)
    return;
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(colorOf(state_), 2));
  painter.setBrush(kGround);
  painter.drawRoundedRect(rect().adjusted(1, 1, -1, -1), 5, 5);
  paintHeader(&painter);
  paintPicture(&painter);
  paintWords(&painter);
}

QString CameraTile::shownWords() const {
  const int room = width() - 2 * kMargin;
  QStringList lines;
  QTextLayout layout(words_, font());
  layout.beginLayout();
  for (QTextLine line = layout.createLine(); line.isValid() && lines.size() < kMostLines;
       line = layout.createLine()) {
    line.setLineWidth(room);
    lines << (lines.size() + 1 < kMostLines
                  ? words_.mid(line.textStart(), line.textLength()).trimmed()
                  : fontMetrics().elidedText(words_.mid(line.textStart()), Qt::ElideRight, room));
  }
  layout.endLayout();
  return lines.join('\n');
}

/// At the bottom; more than a line covers the picture's lower edge.
void CameraTile::paintWords(QPainter* painter) const {
  const QRect room = rect().adjusted(kMargin, kMargin, -kMargin, -kMargin);
  constexpr int kLayout = Qt::AlignBottom | Qt::AlignLeft;
  const QString shown = shownWords();
  const QRect words = painter->boundingRect(room, kLayout, shown);
  if (words.height() > lineHeight())
    painter->fillRect(QRect(words.topLeft(), room.bottomRight()), kGround);
  painter->setPen(colorOf(state_));
  painter->drawText(room, kLayout, shown);
}

/// Name on the left, rate and battery on the right as far as there is room.
void CameraTile::paintHeader(QPainter* painter) const {
  const QRect line(kMargin, kMargin - 2, width() - 2 * kMargin, lineHeight());
  const QString name = QString::fromStdString(camera_->name);
  const QFont normal = painter->font();
  QFont bold = normal;
  bold.setBold(true);
  painter->setFont(bold);
  painter->setPen(kText);
  painter->drawText(line, Qt::AlignVCenter | Qt::AlignLeft,
                    painter->fontMetrics().elidedText(name, Qt::ElideRight, line.width()));
  const int room = line.width() - painter->fontMetrics().horizontalAdvance(name) - kMargin;
  painter->setFont(normal);
  QStringList numbers;
  const double rate = camera_->rate(now_);
  if (std::isfinite(rate))
    numbers << QString("%1 Hz").arg(rate, 0, 'f', 0);
  if (std::isfinite(camera_->battery))
    numbers << QString("%1 %").arg(100.0 * camera_->battery, 0, 'f', 0);
  const bool is_low = camera_->battery < 0.2;  // as the driver warns
  while (!numbers.isEmpty() && painter->fontMetrics().horizontalAdvance(numbers.join("   ")) > room)
    is_low ? numbers.removeFirst() : numbers.removeLast();
  painter->setPen(is_low ? colorOf(CameraState::kLate) : kFaint);
  painter->drawText(line, Qt::AlignVCenter | Qt::AlignRight, numbers.join("   "));
}

void CameraTile::paintPicture(QPainter* painter) const {
  const QRectF area = pictureArea();
  painter->save();
  painter->setClipRect(area);
  painter->fillRect(area, kPicture);
  paintCells(painter, area);
  if (camera_->image && camera_->image->width > 0 && camera_->image->height > 0)
    paintSpots(painter, area);
  if (!camera_->hasImages(now_)) {
    painter->fillRect(area, QColor(60, 63, 70, 190));
    painter->setPen(kText);
    painter->drawText(area, Qt::AlignCenter, "no images");
  }
  painter->restore();
}

void CameraTile::paintCells(QPainter* painter, const QRectF& area) const {
  const auto& cells = camera_->status.image_cells;
  if (cells.size() != kCells)
    return;
  const double width = area.width() / kCellColumns;
  const double height = area.height() / kCellRows;
  for (int i = 0; i < kCells; ++i) {
    const int column = i % kCellColumns, row = i / kCellColumns;
    if (cells[static_cast<std::size_t>(i)])
      painter->fillRect(QRectF(area.left() + column * width, area.top() + row * height, width - 1.0,
                               height - 1.0),
                        kCell);
  }
}

/// Masks, trails, and the newest spots with the sizes that the camera reports.
void CameraTile::paintSpots(QPainter* painter, const QRectF& area) const {
  const double scale = area.width() / camera_->image->width;
  const auto at = [&](double x, double y) {
    return QPointF(area.left() + (x + 0.5) * scale, area.top() + (y + 0.5) * scale);
  };
  if (camera_->calibration) {
    painter->setPen(QPen(kMask.lighter(), 1, Qt::DashLine));
    painter->setBrush(kMask);
    for (const auto& mask : camera_->calibration->masks)
      painter->drawEllipse(at(mask.x, mask.y), mask.radius * scale, mask.radius * scale);
  }
  painter->setPen(Qt::NoPen);
  for (const CameraView::Trace& trace : camera_->trail) {
    QColor color = colorOf(state_);
    color.setAlphaF(std::clamp(0.6 * (1.0 - (now_ - trace.time) / CameraView::kTrail), 0.0, 0.6));
    painter->setBrush(color);
    painter->drawEllipse(at(trace.x, trace.y), 1.5, 1.5);
  }
  for (const auto& spot : camera_->image->blobs) {
    const double radius = 2.5 + 0.4 * (std::isfinite(spot.size) ? spot.size : 2.0);
    painter->setBrush(camera_->isMasked(spot) ? kFaint : kSpot);
    painter->drawEllipse(at(spot.x, spot.y), radius, radius);
  }
}

}  // namespace wiimote_tracker::panel
