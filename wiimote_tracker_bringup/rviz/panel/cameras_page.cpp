#include "cameras_page.h"

#include "camera_tile.h"

#include <QLabel>
#include <QScrollArea>
#include <QScrollBar>
#include <QVBoxLayout>

#include <algorithm>

namespace wiimote_tracker::panel {
namespace {

constexpr int kGap = 6;              // [px of the screen]
constexpr int kNarrowestTile = 190;  // [px of the screen]
constexpr std::size_t kFew = 8;      // cameras; more have smaller tiles
constexpr int kNarrowestOfMany = 130;

}  // namespace

CamerasPage::CamerasPage(QWidget* parent)
    : QWidget(parent), summary_(new QLabel(this)), scroll_(new QScrollArea(this)) {
  summary_->setObjectName("summary");
  summary_->setWordWrap(true);
  scroll_->setFrameShape(QFrame::NoFrame);
  scroll_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  scroll_->setWidget(new QWidget);
  scroll_->viewport()->setAutoFillBackground(false);  // the ground is the page's
  scroll_->widget()->setAutoFillBackground(false);
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(summary_);
  layout->addWidget(scroll_, 1);
}

void CamerasPage::show(const TrackerView& view, double now) {
  summary_->setText(QString::fromStdString(view.summary(now)));
  const std::vector<CameraView>& cameras = view.cameras();
  if (tiles_.size() != cameras.size()) {
    for (; tiles_.size() > cameras.size(); tiles_.pop_back())
      delete tiles_.back();
    while (tiles_.size() < cameras.size())
      tiles_.push_back(new CameraTile(scroll_->widget()));
    arrange();
  }
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    tiles_[i]->setObjectName(QString::fromStdString(cameras[i].name));
    tiles_[i]->show(cameras[i], view.stateOf(cameras[i], now), view.wordsOf(cameras[i], now), now);
  }
}

void CamerasPage::resizeEvent(QResizeEvent*) {
  arrange();
}

void CamerasPage::arrange() {
  const int width = scroll_->width() - scroll_->verticalScrollBar()->sizeHint().width();
  const int narrowest = tiles_.size() > kFew ? kNarrowestOfMany : kNarrowestTile;
  const int columns = std::max((width + kGap) / (narrowest + kGap), 1);
  const int tile_width = (width + kGap) / columns - kGap;
  int top = 0, row_height = 0;
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    const int column = static_cast<int>(i) % columns;
    if (column == 0 && i > 0) {
      top += row_height + kGap;
      row_height = 0;
    }
    const int height = tiles_[i]->heightForWidth(tile_width);
    row_height = std::max(row_height, height);
    tiles_[i]->setGeometry(column * (tile_width + kGap), top, tile_width, height);
    tiles_[i]->setVisible(true);
  }
  scroll_->widget()->resize(width, top + row_height);
}

}  // namespace wiimote_tracker::panel
