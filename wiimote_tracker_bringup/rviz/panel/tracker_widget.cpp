#include "tracker_widget.h"

#include "cameras_page.h"

#include <QTabWidget>
#include <QTimer>
#include <QVBoxLayout>

namespace wiimote_tracker::panel {
namespace {

constexpr int kRefreshPeriod = 66;  // [ms]

}  // namespace

TrackerWidget::TrackerWidget(QWidget* parent)
    : QWidget(parent), pages_(new QTabWidget(this)), cameras_(new CamerasPage(pages_)) {
  pages_->addTab(cameras_, "Cameras");
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(pages_);
  auto* timer = new QTimer(this);
  connect(timer, &QTimer::timeout, this, &TrackerWidget::refresh);
  timer->start(kRefreshPeriod);
}

void TrackerWidget::refresh() {
  link_.poll();
  const double now = Link::now();
  if (cameras_->isVisible())
    cameras_->show(view_, now);
}

}  // namespace wiimote_tracker::panel
