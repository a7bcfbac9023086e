#pragma once

#include <QHeaderView>
#include <QString>
#include <QStringList>
#include <QTableWidget>

#include <cmath>
#include <vector>

namespace wiimote_tracker::panel {

/// A number of a table; "-" where it is not known.
inline QString figure(double value, int decimals) {
  return std::isfinite(value) ? QString::number(value, 'f', decimals) : "-";
}

/// A table to be read.
class Table : public QTableWidget {
 public:
  Table(const QString& name, const QStringList& columns, QWidget* parent)
      : QTableWidget(0, columns.size(), parent) {
    setObjectName(name);
    setHorizontalHeaderLabels(columns);
    verticalHeader()->hide();
    setEditTriggers(QAbstractItemView::NoEditTriggers);
  }

  /// @param rows a text per column each
  void show(const std::vector<QStringList>& rows) {
    setRowCount(static_cast<int>(rows.size()));
    for (int row = 0; row < rowCount(); ++row) {
      for (int column = 0; column < columnCount(); ++column) {
        if (!item(row, column))
          setItem(row, column, new QTableWidgetItem);
        item(row, column)->setText(rows[static_cast<std::size_t>(row)][column]);
      }
    }
  }
};

}  // namespace wiimote_tracker::panel
