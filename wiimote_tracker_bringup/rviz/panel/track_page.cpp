#include "track_page.h"

#include "figure.h"

#include <QDir>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTableWidget>
#include <QVBoxLayout>

#include <array>

namespace wiimote_tracker::panel {

TrackPage::TrackPage(QWidget* parent)
    : QWidget(parent),
      summary_(new QLabel(this)),
      events_(new QLabel(this)),
      recording_(new QLabel(this)),
      leds_(addTable("LED", "cameras", this)),
      bodies_(addTable("body", "LEDs", this)),
      path_(new QLineEdit(QDir::homePath() + "/tracker", this)),
      record_(new QPushButton("Record", this)) {
  summary_->setObjectName("tracked");
  leds_->setObjectName("leds");
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

QTableWidget* TrackPage::addTable(const QString& name, const QString& seen_by, QWidget* parent) {
  auto* table = new QTableWidget(0, 8, parent);
  table->setHorizontalHeaderLabels({name, "state", "x m", "y m", "z m", "± mm", "m/s", seen_by});
  table->verticalHeader()->hide();
  table->horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  table->horizontalHeader()->setStretchLastSection(true);
  table->setEditTriggers(QAbstractItemView::NoEditTriggers);
  // All columns fit into a panel beside the scene.
  QFont font = table->font();
  font.setPointSizeF(0.85 * font.pointSizeF());
  table->setFont(font);
  table->horizontalHeader()->setFont(font);
  return table;
}

void TrackPage::fill(QTableWidget* table, const std::vector<TracksView::Row>& rows) {
  table->setRowCount(static_cast<int>(rows.size()));
  for (int i = 0; i < table->rowCount(); ++i) {
    const TracksView::Row& row = rows[static_cast<std::size_t>(i)];
    const std::array<QString, 8> cells = {QString::fromStdString(row.name),
                                          QString::fromStdString(row.state),
                                          figure(row.x, 3),
                                          figure(row.y, 3),
                                          figure(row.z, 3),
                                          figure(1e3 * row.stddev, 1),
                                          figure(row.speed, 2),
                                          QString::fromStdString(row.seen_by)};
    for (int column = 0; column < table->columnCount(); ++column) {
      if (!table->item(i, column))
        table->setItem(i, column, new QTableWidgetItem);
      table->item(i, column)->setText(cells[static_cast<std::size_t>(column)]);
    }
  }
}

void TrackPage::show(const TracksView& tracks, double now) {
  summary_->setText(QString::fromStdString(tracks.summary(now)));
  fill(leds_, tracks.leds(now));
  const auto bodies = tracks.bodies(now);
  fill(bodies_, bodies);
  bodies_->setVisible(!bodies.empty());
  QStringList events;
  for (const std::string& event : tracks.events())
    events << QString::fromStdString(event);
  events_->setText(events.join("\n"));
  record_->setText(recorder_.isRunning() ? "Stop" : "Record");
  recording_->setText(recorder_.words());
}

QString TrackPage::recordPath() const {
  return path_->text();
}

void TrackPage::setRecordPath(const QString& path) {
  path_->setText(path);
}

}  // namespace wiimote_tracker::panel
