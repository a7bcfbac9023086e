#include "track_page.h"

#include "table.h"

#include <QDir>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QVBoxLayout>

#include <vector>

namespace wiimote_tracker::panel {
namespace {

Table* tracksTable(const QString& name, const QString& led, const QString& seen_by, QWidget* page) {
  auto* table = new Table(name, {led, "state", "x m", "y m", "z m", "± mm", "m/s", seen_by}, page);
  table->horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  table->horizontalHeader()->setStretchLastSection(true);
  // All columns fit into a panel beside the scene.
  QFont font = table->font();
  font.setPointSizeF(0.85 * font.pointSizeF());
  table->setFont(font);
  table->horizontalHeader()->setFont(font);
  return table;
}

std::vector<QStringList> textsOf(const std::vector<TracksView::Row>& rows) {
  std::vector<QStringList> texts;
  for (const TracksView::Row& row : rows)
    texts.push_back({QString::fromStdString(row.name), QString::fromStdString(row.state),
                     figure(row.x, 3), figure(row.y, 3), figure(row.z, 3),
                     figure(1e3 * row.stddev, 1), figure(row.speed, 2),
                     QString::fromStdString(row.seen_by)});
  return texts;
}

}  // namespace

TrackPage::TrackPage(QWidget* parent)
    : QWidget(parent),
      summary_(new QLabel(this)),
      events_(new QLabel(this)),
      recording_(new QLabel(this)),
      leds_(tracksTable("leds", "LED", "cameras", this)),
      bodies_(tracksTable("bodies", "body", "LEDs", this)),
      path_(new QLineEdit(QDir::homePath() + "/tracker", this)),
      record_(new QPushButton("Record", this)) {
  summary_->setObjectName("tracked");
  record_->setObjectName("record");
  path_->setObjectName("path");
  recording_->setObjectName("recording");
  for (QLabel* label : {summary_, events_, recording_})
    label->setWordWrap(true);
  QFont larger = font();
  larger.setPointSizeF(1.25 * larger.pointSizeF());
  summary_->setFont(larger);
  path_->setToolTip("path and prefix of the bag's name; the date is added");
  connect(record_, &QPushButton::clicked, this, [this] {
    if (recorder_.isRunning())
      recorder_.stop();
    else
      recorder_.start(path_->text());
  });
  auto* row = new QHBoxLayout;
  row->addWidget(path_, 1);
  row->addWidget(record_);
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(summary_);
  layout->addWidget(leds_, 2);
  layout->addWidget(bodies_, 1);
  layout->addWidget(events_);
  layout->addWidget(recording_);
  layout->addLayout(row);  // last: the button stays in its place
}

void TrackPage::show(const TracksView& tracks, double now) {
  summary_->setText(QString::fromStdString(tracks.summary(now)));
  leds_->show(textsOf(tracks.leds(now)));
  const auto bodies = tracks.bodies(now);
  bodies_->show(textsOf(bodies));
  bodies_->setVisible(!bodies.empty());
  QStringList events;
  for (const std::string& event : tracks.events())
    events << QString::fromStdString(event);
  events_->setText(events.join("\n"));
  record_->setText(recorder_.isRunning() ? "Stop" : "Record");
  recording_->setText(recorder_.words());
}

void TrackPage::load(const rviz::Config& config) {
  QString path = path_->text();
  config.mapGetString("Record To", &path);
  path_->setText(path);
}

void TrackPage::save(rviz::Config* config) const {
  config->mapSetValue("Record To", path_->text());
}

}  // namespace wiimote_tracker::panel
