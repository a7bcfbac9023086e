#include "tracker_panel.h"

#include "calibrate_page.h"
#include "cameras_page.h"
#include "health_page.h"
#include "track_page.h"

#include <QLabel>
#include <QTabWidget>
#include <QTimer>
#include <QVBoxLayout>

#include <pluginlib/class_list_macros.hpp>

namespace wiimote_tracker::panel {
namespace {

constexpr int kRefreshPeriod = 66;  // [ms]

}  // namespace

TrackerPanel::TrackerPanel()
    : master_(new QLabel(this)),
      pages_(new QTabWidget(this)),
      cameras_(new CamerasPage(pages_)),
      calibrate_(new CalibratePage(pages_, [this](const Request& r) { requests_.send(r); })),
      track_(new TrackPage(pages_)),
      health_(new HealthPage(pages_)) {
  pages_->addTab(cameras_, "Cameras");
  pages_->addTab(calibrate_, "Calibrate");
  pages_->addTab(track_, "Track");
  pages_->addTab(health_, "Health");
  connect(pages_, &QTabWidget::currentChanged, this, [this] { Q_EMIT configChanged(); });
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(master_);
  layout->addWidget(pages_);
  master_->setWordWrap(true);
  master_->hide();
  auto* timer = new QTimer(this);
  connect(timer, &QTimer::timeout, this, [this] { refresh(); });
  timer->start(kRefreshPeriod);
}

void TrackerPanel::refresh() {
  ros_input_.poll();
  requests_.poll();
  track_->poll();
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

void TrackerPanel::load(const rviz::Config& config) {
  rviz::Panel::load(config);
  int page = 0;
  if (config.mapGetInt("Page", &page))
    pages_->setCurrentIndex(page);
  calibrate_->load(config);
  track_->load(config);
}

void TrackerPanel::save(rviz::Config config) const {
  rviz::Panel::save(config);
  config.mapSetValue("Page", pages_->currentIndex());
  calibrate_->save(&config);
  track_->save(&config);
}

}  // namespace wiimote_tracker::panel

PLUGINLIB_EXPORT_CLASS(wiimote_tracker::panel::TrackerPanel, rviz::Panel)
