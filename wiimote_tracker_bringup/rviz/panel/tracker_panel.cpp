#include "calibrate_page.h"
#include "track_page.h"
#include "tracker_widget.h"

#include <QTabWidget>
#include <QVBoxLayout>

#include <rviz/panel.h>
#include <pluginlib/class_list_macros.hpp>

namespace wiimote_tracker::panel {

/// The panel in rviz. The .rviz file keeps which page is in front, and what was typed.
class TrackerPanel : public rviz::Panel {
 public:
  TrackerPanel() : widget_(new TrackerWidget(this)) {
    auto* layout = new QVBoxLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->addWidget(widget_);
    connect(widget_->pages(), &QTabWidget::currentChanged, this,
            [this] { Q_EMIT configChanged(); });
  }

  void load(const rviz::Config& config) override {
    rviz::Panel::load(config);
    int page = 0;
    if (config.mapGetInt("Page", &page))
      widget_->pages()->setCurrentIndex(page);
    float side = 0.0f, wand_length = 0.0f;
    QString rig_file;
    config.mapGetFloat("Side of Square", &side);
    config.mapGetFloat("Length of Wand", &wand_length);
    config.mapGetString("Rig File", &rig_file);
    widget_->calibratePage()->restore(side, wand_length, rig_file);
    QString record_path;
    if (config.mapGetString("Record To", &record_path))
      widget_->trackPage()->setRecordPath(record_path);
  }

  void save(rviz::Config config) const override {
    rviz::Panel::save(config);
    config.mapSetValue("Page", widget_->pages()->currentIndex());
    const CalibratePage* calibrate = widget_->calibratePage();
    config.mapSetValue("Side of Square", calibrate->side());
    config.mapSetValue("Length of Wand", calibrate->wandLength());
    config.mapSetValue("Rig File", calibrate->path());
    config.mapSetValue("Record To", widget_->trackPage()->recordPath());
  }

 private:
  TrackerWidget* widget_;
};

}  // namespace wiimote_tracker::panel

PLUGINLIB_EXPORT_CLASS(wiimote_tracker::panel::TrackerPanel, rviz::Panel)
