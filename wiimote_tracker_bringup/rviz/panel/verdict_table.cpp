#include "verdict_table.h"

#include "table.h"

#include <QLabel>
#include <QVBoxLayout>

#include <vector>

namespace wiimote_tracker::panel {

using wiimote_tracker_msgs::CalibrationVerdict;

namespace {

/// How right points are, and what to measure next to improve that; empty: not known.
QString measurementWords(const CalibrationVerdict& verdict) {
  QString words;
  if (verdict.expected_error > 0.0)
    words += "\nExpected error at the corners and above them: " +
             figure(1e3 * verdict.expected_error, 1) + " mm (RMS).";
  if (!verdict.next_measurement.empty())
    words += "\nBest to measure next: " + QString::fromStdString(verdict.next_measurement);
  return words;
}

}  // namespace

VerdictTable::VerdictTable(QWidget* parent) : QWidget(parent) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(words_ = new QLabel(this));
  words_->setObjectName("verdict");
  words_->setWordWrap(true);
  words_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  const QStringList columns = {"camera", "px", "mm", "fits %", "± mm", "± °"};
  layout->addWidget(table_ = new Table("table", columns, this));
  const QStringList meanings = {"",
                                "residual in the image [px]",
                                "residual at the distance of the LED [mm]",
                                "share of the spots that fit",
                                "standard deviation of the camera's place",
                                "standard deviation of the camera's orientation"};
  for (int column = 0; column < meanings.size(); ++column)
    table_->horizontalHeaderItem(column)->setToolTip(meanings[column]);
  table_->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  table_->horizontalHeader()->setSectionResizeMode(0, QHeaderView::ResizeToContents);
  table_->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
}

void VerdictTable::show(const CalibrationVerdict* verdict) {
  const std::string rig = verdict ? verdict->rig_id : "";
  setVisible(verdict != nullptr);
  if (rig == shown_rig_)
    return;
  shown_rig_ = rig;
  if (!verdict)
    return;
  words_->setText(QString::fromStdString(verdict->text) + measurementWords(*verdict));
  std::vector<QStringList> rows;
  for (const auto& camera : verdict->cameras)
    rows.push_back({QString::fromStdString(camera.name), figure(camera.residual_px, 2),
                    figure(1e3 * camera.residual_m, 1), figure(1e2 * camera.inlier_share, 0),
                    figure(1e3 * camera.position_stddev, 1),
                    figure(camera.rotation_stddev * 180.0 / M_PI, 3)});
  table_->show(rows);
  table_->resizeRowsToContents();
  int height = table_->horizontalHeader()->sizeHint().height() + 2 * table_->frameWidth();
  for (int row = 0; row < table_->rowCount(); ++row)
    height += table_->rowHeight(row);
  table_->setFixedHeight(height);
}

}  // namespace wiimote_tracker::panel
