#include "tracker_widget.h"

#include "calibrate_page.h"
#include "cameras_page.h"
#include "health_page.h"
#include "track_page.h"

#include <QLabel>
#include <QTabWidget>
#include <QTimer>
#include <QVBoxLayout>

namespace wiimote_tracker::panel {
namespace {

constexpr int kRefreshPeriod = 66;  // [ms]

}  // namespace

TrackerWidget::TrackerWidget(QWidget* parent)
    : QWidget(parent),
      master_(new QLabel(this)),
      pages_(new QTabWidget(this)),
      cameras_(new CamerasPage(pages_)),
      calibrate_(new CalibratePage(pages_, [this](const Request& r) { requests_.send(r); })),
      track_(new TrackPage(pages_)),
      health_(new HealthPage(pages_)) {
  pages_->addTab(cameras_, "Cameras");
  pages_->addTab(calibrate_, "Calibrate");
  pages_->addTab(track_, "Track");
  pages_->addTab(health_, "Health");
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(master_);
  layout->addWidget(pages_);
  master_->setWordWrap(true);
  master_->hide();
  auto* timer = new QTimer(this);
  connect(timer, &QTimer::timeout, this, &TrackerWidget::refresh);
  timer->start(kRefreshPeriod);
}

void TrackerWidget::refresh() {
  ros_input_.poll();
  requests_.poll();
  master_->setText(QString::fromStdString(ros_input_.masterProblem()));
  master_->setVisible(!master_->text().isEmpty());
  const double now = RosInput::now();
  if (cameras_->isVisible())
    cameras_->show(views_.cameras, now);
  if (calibrate_->isVisible())
    calibrate_->show(views_.guide, now);
  if (track_->isVisible())
    track_->show(views_.tracks, now);
  if (health_->isVisible())
    health_->show(views_.health, now);
}

}  // namespace wiimote_tracker::panel
