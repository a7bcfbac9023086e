#pragma once

#include "camera_view.h"

#include <QString>
#include <QWidget>

#include <optional>

class QPainter;

namespace wiimote_tracker::panel {

/// One camera: its picture with spots, trails, masks and the cells that a wave has filled; name,
/// rate, battery, and its state by colour and in words, of which the tooltip has all.
class CameraTile : public QWidget {
 public:
  explicit CameraTile(QWidget* parent) : QWidget(parent) {}

  void show(const CameraView& camera, CameraState state, const std::string& words, double now);

  int heightForWidth(int width) const override;
  QString words() const { return words_; }
  /// As far as they have room: in a few lines of the tile's width.
  QString shownWords() const;

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  int lineHeight() const;
  QRectF pictureArea() const;
  void paintHeader(QPainter* painter) const;
  void paintWords(QPainter* painter) const;
  void paintPicture(QPainter* painter) const;
  void paintCells(QPainter* painter, const QRectF& area) const;
  void paintSpots(QPainter* painter, const QRectF& area) const;

  std::optional<CameraView> camera_;
  CameraState state_ = CameraState::kFrozen;
  QString words_;
  double now_ = 0.0;
};

}  // namespace wiimote_tracker::panel
